// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground_setup.hpp"

namespace grouser::scene {
struct Scene;
}

namespace grouser::setup {

/// Throws InputError where output.fields_cell does not fit the scene: no grains, cells smaller than a grain, more cells
/// than kMostFieldCells, no box where all grains enter later.
void checkFields(const scene::Scene& scene, const coupling::GroundSetup& ground);

/// 33 sums of 8 bytes on the device, 72 bytes a frame in the file.
inline constexpr double kMostFieldCells = 1e6;

} // namespace grouser::setup
