// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground_setup.hpp"

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// Whether checkFillSizes() and checkBedSize() must still be called.
enum class SizeChecks { due, passed };

/// The ground of a scene, for this step and number of ranks: reads the height-map, places grains, finds the laws of all
/// contacts. Nothing is computed on a device. Throws InputError with the place of the error.
coupling::GroundSetup groundSetup(const scene::Scene& scene, double timeStep, int ranks = 1,
                                  SizeChecks sizes = SizeChecks::due);

/// Throws the errors of groundSetup() without laying a bed: overlapping grains (up to a hundred thousand of them),
/// sources in solids, surfaces too fast for the step.
void checkGround(const scene::Scene& scene, double timeStep);

} // namespace grouser::setup
