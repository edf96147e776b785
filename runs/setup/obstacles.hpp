// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/obstacles.hpp"

#include <vector>

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// Fixed planes, boxes, cylinders and meshes of a scene.
std::vector<coupling::SurfaceSetup> surfacesAtRest(const scene::Scene& scene);

/// These surfaces as obstacles of vehicle, bodies and fluid; empty without a vehicle, bodies with shapes or a fluid.
/// Friction follows from vehicle.material and the surface's material; without vehicle.material it is friction_ground of
/// the vehicle file.
std::vector<coupling::Obstacle> obstaclesOf(const scene::Scene& scene);

/// Returns true if the hull of the scene's vehicle has contacts.
bool hullTouches(const scene::Scene& scene);

} // namespace grouser::setup
