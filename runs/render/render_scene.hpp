// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "base/vec.hpp"
#include "runs/render/colour.hpp"

#include <vector>

/// What a picture is painted of.
namespace grouser::render {

struct RenderSphere {
  base::Vec3f centre; ///< [m]
  float radius{};     ///< [m]
  Colour colour;
};

struct RenderMesh {
  base::TriangleMesh mesh;
  base::Pose pose; ///< X_WB
  Colour colour;
  bool oneSided = false;                  ///< not seen from behind: a container's near wall does not hide what is in it
  std::vector<Colour> vertexColours = {}; ///< of each vertex, in place of `colour`; empty: one colour
};

struct RenderScene {
  std::vector<RenderSphere> spheres;
  std::vector<RenderMesh> meshes;
};

} // namespace grouser::render
