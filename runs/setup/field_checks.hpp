// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground_setup.hpp"

namespace grouser::scene {
struct Scene;
}

namespace grouser::setup {

/// Throws InputError if output.fields_cell does not fit the scene: no grains, cells smaller than a grain, more cells
/// than kMaxFieldCells, or no box although all grains enter later.
void checkFields(const scene::Scene& scene, const coupling::GroundSetup& ground);

/// A cell requires 33 sums of 8 bytes on the device and 72 bytes per frame in the file.
inline constexpr double kMaxFieldCells = 1e6;

} // namespace grouser::setup
