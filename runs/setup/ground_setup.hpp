// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground_setup.hpp"

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// Whether checkFillSizes() and checkBedSize() are still to be asked.
enum class SizeChecks { due, passed };

/// The ground of a scene, for this step and number of ranks: reads the height-map, places grains, finds the laws of all
/// contacts. Nothing is computed on a device. Throws InputError with the place of what is not possible.
coupling::GroundSetup groundSetup(const scene::Scene& scene, double timeStep, int ranks = 1,
                                  SizeChecks sizes = SizeChecks::due);

/// Throws what groundSetup() would, and lays nothing: grains that overlap each other (up to a hundred thousand of
/// them), sources in solids, surfaces too quick for the step.
void checkGround(const scene::Scene& scene, double timeStep);

} // namespace grouser::setup
