// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// Moving surfaces act on grains only, so a vehicle would pass through them. Throws InputError if a moving surface is
/// at the vehicle's initial position or in its path straight ahead or back, or if there is neither terrain nor grains
/// below a free vehicle. For plan and run. For fixed surfaces see obstacles.hpp.
void checkVehicleSurroundings(const scene::Scene& scene);

/// Warnings about a scene with a vehicle, one sentence each: moving surfaces that the vehicle would pass through, an
/// end of the terrain that it would reach during the run, speeds that start with a jump.
std::vector<std::string> vehicleWarnings(const scene::Scene& scene);

/// Notes on meshes of the scene and its vehicle that were changed while they were read.
std::vector<std::string> meshNotes(const scene::Scene& scene);

} // namespace grouser::setup
