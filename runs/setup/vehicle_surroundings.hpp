// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// Surfaces that move act on grains alone: a vehicle would pass through them. Throws InputError where one of them
/// stands where the vehicle is set down, or in the way that it can drive straight ahead or back, and where a vehicle
/// free to fall has neither terrain nor grains below. Called for plan and run. Surfaces at rest are met: see
/// obstacles.hpp.
void checkVehicleSurroundings(const scene::Scene& scene);

/// What a user should know of a vehicle's scene before it runs, a sentence each: surfaces that move and that it would
/// pass through, an end of the terrain that it comes to before the run's, speeds that begin with a jump.
std::vector<std::string> vehicleWarnings(const scene::Scene& scene);

/// Meshes of the scene and of its vehicle that were not read as they stand in their files.
std::vector<std::string> meshNotes(const scene::Scene& scene);

} // namespace grouser::setup
