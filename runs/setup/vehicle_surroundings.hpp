// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// Moving surfaces act on grains only, so a vehicle would pass through them. Throws InputError where one of them is at
/// the vehicle's initial position or in its path straight ahead or back, and where a vehicle free to fall has neither
/// terrain nor grains below. Called for plan and run. For surfaces at rest see obstacles.hpp.
void checkVehicleSurroundings(const scene::Scene& scene);

/// Warnings on a vehicle's scene before it runs, a sentence each: moving surfaces that it would pass through, an end of
/// the terrain that it reaches during the run, speeds that start with a jump.
std::vector<std::string> vehicleWarnings(const scene::Scene& scene);

/// Notes on meshes of the scene and its vehicle that were changed on reading.
std::vector<std::string> meshNotes(const scene::Scene& scene);

} // namespace grouser::setup
