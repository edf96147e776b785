// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/obstacles.hpp"

#include <vector>

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// Planes, boxes, cylinders and meshes of a scene that nothing moves.
std::vector<coupling::SurfaceSetup> surfacesAtRest(const scene::Scene& scene);

/// Those as parts of the vehicle and bodies meet them; empty without a vehicle, bodies with shapes or a fluid.
/// Friction is that of vehicle.material and the surface's where the scene gives the vehicle one, else friction_ground
/// of its file.
std::vector<coupling::Obstacle> obstaclesOf(const scene::Scene& scene);

/// Whether the hull of the scene's vehicle touches anything.
bool hullTouches(const scene::Scene& scene);

} // namespace grouser::setup
