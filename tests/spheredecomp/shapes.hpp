// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "base/sphere_set.hpp"
#include "spheredecomp/decompose.hpp"

namespace grouser::spheredecomp::shapes {

using base::TriangleMesh;
using base::Vec3d;

/// Axis-parallel box of twelve triangles, appended to a mesh.
inline TriangleMesh box(const Vec3d& low, const Vec3d& high, TriangleMesh mesh = {}) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  for (const std::uint32_t i :
       {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5})
    mesh.indices.push_back(first + i);
  return mesh;
}

/// Body of revolution about z with a profile (radius, z) that starts and ends on the axis, z ascending.
inline TriangleMesh turned(const std::vector<std::pair<double, double>>& profile, std::uint32_t facets) {
  TriangleMesh mesh;
  for (const auto& [r, z] : profile)
    for (std::uint32_t k = 0; k < facets; ++k) {
      const double a = 2 * base::kPi * k / facets;
      mesh.vertices.push_back({r * base::cos(a), r * base::sin(a), z});
    }
  for (std::uint32_t p = 0; p + 1 < profile.size(); ++p)
    for (std::uint32_t k = 0; k < facets; ++k) {
      const std::uint32_t a = p * facets + k, b = p * facets + (k + 1) % facets, c = a + facets, d = b + facets;
      if (profile[p].first > 0) mesh.indices.insert(mesh.indices.end(), {a, b, d});
      if (profile[p + 1].first > 0) mesh.indices.insert(mesh.indices.end(), {a, d, c});
    }
  // The axis has one vertex per facet; merges them.
  for (std::uint32_t& i : mesh.indices) {
    if (i < facets) i = 0;
    if (i >= (profile.size() - 1) * facets) i = static_cast<std::uint32_t>((profile.size() - 1) * facets);
  }
  return mesh;
}

inline TriangleMesh ball(double radius, std::uint32_t facets) {
  std::vector<std::pair<double, double>> profile;
  const std::uint32_t half = facets / 2;
  for (std::uint32_t i = 0; i <= half; ++i) {
    const double a = base::kPi * i / half;
    profile.emplace_back(i == 0 || i == half ? 0 : radius * base::sin(a), -radius * base::cos(a));
  }
  return turned(profile, facets);
}

inline TriangleMesh cylinder(double radius, double height, std::uint32_t facets) {
  return turned({{0, 0}, {radius, 0}, {radius, height}, {0, height}}, facets);
}

/// Converted to spheres of that radius [m], with other options at their defaults.
inline base::SphereSet cut(const TriangleMesh& mesh, double radius) {
  DecompositionOptions options;
  options.radius = radius;
  return decompose(mesh, "part", options);
}

} // namespace grouser::spheredecomp::shapes
