// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/records.hpp"
#include "runs/support/file_field.hpp"
#include "runs/support/hdf5_file.hpp"

#include <memory>
#include <string>
#include <vector>

/// A fluid in frames.h5: /000012/fluid/{position [n, 3], velocity [n, 3], pressure [n]}.
namespace grouser::output {

/// Upper bound of the file size of the fluid in one frame [bytes].
std::uint64_t bytesOfFluid(const FluidPoints& fluid);
/// `frame`: group of the frame.
void writeFluid(support::Hdf5File& file, const std::string& frame, const FluidPoints& fluid);
/// Number of fluid particles of a frame in the file; 0 if the frame has no fluid.
std::uint64_t fluidCount(const support::Hdf5File& file, const std::string& frame);
/// Geometry and attributes of the fluid of a frame for frames.xdmf.
std::string fluidXdmf(const support::Hdf5File& file, const std::string& frame);
/// Reads the fluid of a frame; null if the frame has no fluid. Throws base::InputError if the data are damaged.
std::shared_ptr<const FluidPoints> readFluid(const support::Hdf5File& file, const std::string& frame);

/// Adds the particles to a picture as spheres that overlap, so that the fluid is opaque.
void drawFluid(const FluidPoints& fluid, std::vector<base::Vec3f>& positions, std::vector<float>& radii,
               std::vector<float>& speeds);

/// For docs/files.md; `frame`: "FRAME/".
std::vector<support::FileField> fluidFields(const std::string& frame);

} // namespace grouser::output
