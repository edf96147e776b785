// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "base/vec.hpp"
#include "runs/render/colour.hpp"

#include <vector>

/// Objects of a picture.
namespace grouser::render {

struct RenderSphere {
  base::Vec3f centre; ///< [m]
  float radius{};     ///< [m]
  Colour colour;
};

struct RenderMesh {
  base::TriangleMesh mesh;
  base::Pose pose; ///< pose of the body in the world, X_WB
  Colour colour;
  bool oneSided = false; ///< invisible from behind: the near wall of a container does not hide its contents
  std::vector<Colour> vertexColours = {}; ///< colours of the vertices, instead of `colour`; empty: one colour
};

struct RenderScene {
  std::vector<RenderSphere> spheres;
  std::vector<RenderMesh> meshes;
};

} // namespace grouser::render
