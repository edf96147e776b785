// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "runs/setup/drawn_planes.hpp"

namespace grouser::output {

/// Planes of a scene as triangles, for pictures: for each plane, the polygon that bounds the space between all planes,
/// within a box around the grains. Excludes planes that move or have a name; empty if there are no other planes.
base::TriangleMesh planeMesh(const setup::DrawnPlanes& drawn);
/// Mesh of one plane at its initial position.
base::TriangleMesh planeMesh(const setup::DrawnPlanes& drawn, std::size_t plane);

/// Planes that face up, extended to the other planes, so that pictures show a whole floor.
base::TriangleMesh floorMesh(const setup::DrawnPlanes& drawn);
/// Mesh of one such plane; for a plane that does not face up, the same as planeMesh().
base::TriangleMesh floorMesh(const setup::DrawnPlanes& drawn, std::size_t plane);

} // namespace grouser::output
