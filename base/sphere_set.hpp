// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace grouser::base {

/// One sphere of a decomposed part, in the part's mesh frame.
struct SetSphere {
  Vec3d centre;       ///< [m]
  double radius{};    ///< [m]
  Vec3d normal;       ///< outward unit normal of the mesh at the nearest surface point; zero for an interior sphere
  double offset{};    ///< [m] that plane is normal . x = offset
  double flat{};      ///< [m] radius of the flat disc: within this tangential distance of `centre` the part's surface is the
                      ///< plane; 0 next to an edge, where the sphere itself rounds the edge
  double area{};      ///< [m2] mesh area this sphere stands for; the sum over a set is the mesh's area; 0 inside
  bool surface() const { return area > 0 || norm2(normal) > 0; }
};

/// A rigid part cut into spheres: surface spheres first, then interior ones.
struct SphereSet {
  std::string name;
  std::vector<SetSphere> spheres;
  std::size_t surfaceCount{};
  double spacing{};   ///< [m] lattice spacing
  double radius{};    ///< [m] sphere radius
  double meshVolume{}; ///< [m3]
  double meshArea{};   ///< [m2]
};

/// Triangle mesh: vertices [m], counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices; ///< 3 a triangle
};

} // namespace grouser::base
