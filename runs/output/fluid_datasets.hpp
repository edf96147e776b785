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

/// Upper bound of the size of one frame's fluid in the file [bytes].
std::uint64_t bytesOfFluid(const FluidPoints& fluid);
/// `frame`: the group of the frame.
void writeFluid(support::Hdf5File& file, const std::string& frame, const FluidPoints& fluid);
/// Particles of a frame's fluid in the file; 0 where it has none.
std::uint64_t fluidCount(const support::Hdf5File& file, const std::string& frame);
/// Attributes and geometry of a frame's fluid for frames.xdmf.
std::string fluidXdmf(const support::Hdf5File& file, const std::string& frame);
/// Reads a frame's fluid; null if the frame has none. Throws base::InputError if the data are damaged.
std::shared_ptr<const FluidPoints> readFluid(const support::Hdf5File& file, const std::string& frame);

/// Adds the particles as spheres for pictures, which overlap so that they hide what lies behind.
void drawFluid(const FluidPoints& fluid, std::vector<base::Vec3f>& positions, std::vector<float>& radii,
               std::vector<float>& speeds);

/// For docs/files.md; `frame`: "FRAME/".
std::vector<support::FileField> fluidFields(const std::string& frame);

} // namespace grouser::output
