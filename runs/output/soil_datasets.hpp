// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/records.hpp"
#include "runs/support/file_field.hpp"
#include "runs/support/hdf5_file.hpp"

#include <memory>
#include <string>
#include <vector>

/// Deformable soil in frames.h5: /000012/soil/{position [v, 3], triangles [t, 3], sinkage [v], pressure [v], ...};
/// compressed, because most of the surface is plane and unloaded.
namespace grouser::output {

/// Upper bound of the file size of the soil in one frame [bytes].
std::uint64_t bytesOfSoil(const SoilSurface& soil);
/// `frame`: group of the frame.
void writeSoil(support::Hdf5File& file, const std::string& frame, const SoilSurface& soil);
/// XML of the soil of a frame for frames.xdmf; empty if the frame has no soil.
std::string soilXdmf(const support::Hdf5File& file, const std::string& frame);
/// Reads the soil of a frame; null if the frame has no soil. Throws base::InputError if the data are damaged.
std::shared_ptr<const SoilSurface> readSoil(const support::Hdf5File& file, const std::string& frame);

/// For docs/files.md; `frame`: "FRAME/".
std::vector<support::FileField> soilSurfaceFields(const std::string& frame);

} // namespace grouser::output
