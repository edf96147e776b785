// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground_setup.hpp"

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// Whether checkFillSizes() and checkBedSize() must still be called.
enum class SizeChecks { due, passed };

/// The ground of a scene for this time step and number of ranks: reads the height-map, places grains, and determines
/// the laws of all contacts. Does not use a device. Throws InputError with the place of the error.
coupling::GroundSetup groundSetup(const scene::Scene& scene, double timeStep, int ranks = 1,
                                  SizeChecks sizes = SizeChecks::due);

/// Throws the errors of groundSetup() without placing a bed: overlapping grains (checked for at most 100 000 grains),
/// sources in solids, surfaces that are too fast for the step.
void checkGround(const scene::Scene& scene, double timeStep);

} // namespace grouser::setup
