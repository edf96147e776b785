// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/records.hpp"
#include "runs/support/file_field.hpp"
#include "runs/support/hdf5_file.hpp"

#include <memory>
#include <string>
#include <vector>

/// Deformable soil in frames.h5: /000012/soil/{position [v, 3], triangles [t, 3], sinkage [v], pressure [v], ...},
/// compressed, for most of it is plane and bears nothing.
namespace grouser::output {

/// Size of the soil of one frame in the file at most [bytes].
std::uint64_t bytesOfSoil(const SoilSurface& soil);
/// `frame`: the group of the frame.
void writeSoil(support::Hdf5File& file, const std::string& frame, const SoilSurface& soil);
/// The soil of a frame for frames.xdmf; empty where it has none.
std::string soilXdmf(const support::Hdf5File& file, const std::string& frame);
/// What writeSoil() wrote; null where there is none. Throws base::InputError where it is damaged.
std::shared_ptr<const SoilSurface> readSoil(const support::Hdf5File& file, const std::string& frame);

/// For docs/files.md; `frame`: "FRAME/".
std::vector<support::FileField> soilSurfaceFields(const std::string& frame);

} // namespace grouser::output
