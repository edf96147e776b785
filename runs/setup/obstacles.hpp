// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/obstacles.hpp"

#include <vector>

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// Planes, boxes, cylinders and meshes of a scene at rest.
std::vector<coupling::SurfaceSetup> surfacesAtRest(const scene::Scene& scene);

/// These surfaces as obstacles of vehicle, bodies and fluid; empty without a vehicle, bodies with shapes or a fluid.
/// Friction is that of vehicle.material and the surface's material if given, else friction_ground of the vehicle file.
std::vector<coupling::Obstacle> obstaclesOf(const scene::Scene& scene);

/// Returns true if the hull of the scene's vehicle has contacts.
bool hullTouches(const scene::Scene& scene);

} // namespace grouser::setup
