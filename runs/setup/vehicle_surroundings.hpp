// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// What stands about a vehicle acts on grains alone: it would pass through planes, boxes, cylinders and meshes. Throws
/// InputError where one of them stands where the vehicle is set down, or in the way that it can drive straight ahead or
/// back, and where a vehicle free to fall has neither terrain nor grains below. Called for plan and run.
void checkVehicleSurroundings(const scene::Scene& scene);

/// What a user should know of a vehicle's scene before it runs, a sentence each: surfaces that it may yet reach and
/// would pass through, speeds that begin with a jump.
std::vector<std::string> vehicleWarnings(const scene::Scene& scene);

} // namespace grouser::setup
