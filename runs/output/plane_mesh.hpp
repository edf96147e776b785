// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "runs/setup/drawn_planes.hpp"

namespace grouser::output {

/// The planes of a scene as triangles, for pictures: of each the polygon that borders the room between all of them,
/// within a box around the grains. Empty without planes; those that move or have a name are left out.
base::TriangleMesh planeMesh(const setup::DrawnPlanes& drawn);
/// One of them, where it is at the start.
base::TriangleMesh planeMesh(const setup::DrawnPlanes& drawn, std::size_t plane);

/// Planes that face up, extended up to the other planes, so that pictures show a floor and not a patch.
base::TriangleMesh floorMesh(const setup::DrawnPlanes& drawn);
/// One of them; where it does not face up, as planeMesh().
base::TriangleMesh floorMesh(const setup::DrawnPlanes& drawn, std::size_t plane);

} // namespace grouser::output
