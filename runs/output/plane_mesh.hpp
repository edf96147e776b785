// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "runs/scene/scene.hpp"

namespace grouser::output {

/// The planes of a scene as triangles, for pictures: of each the polygon that borders the room between all of them,
/// within a box around the grains. Empty without planes; those that move or have a name are left out.
base::TriangleMesh planeMesh(const scene::Scene& scene);
/// One of them, where it is at the start.
base::TriangleMesh planeMesh(const scene::Scene& scene, std::size_t plane);

} // namespace grouser::output
