// SPDX-License-Identifier: BSD-3-Clause
#include "assets/generator/solids.hpp"

#include "base/math.hpp"

namespace grouser::assets {

void loft(TriangleMesh& mesh, const std::vector<Ring>& rings, const Vec3d& startCentre, const Vec3d& endCentre) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto n = static_cast<std::uint32_t>(rings.front().size());
  const auto last = first + n * static_cast<std::uint32_t>(rings.size() - 1);
  for (const Ring& ring : rings) mesh.vertices.insert(mesh.vertices.end(), ring.begin(), ring.end());
  const auto start = static_cast<std::uint32_t>(mesh.vertices.size()), end = start + 1;
  mesh.vertices.push_back(startCentre);
  mesh.vertices.push_back(endCentre);

  auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    add(start, first + i, first + j);
    for (std::uint32_t ring = first; ring < last; ring += n) {
      add(ring + i, ring + n + i, ring + n + j);
      add(ring + i, ring + n + j, ring + j);
    }
    add(end, last + j, last + i);
  }
}

void prism(TriangleMesh& mesh, const std::vector<std::pair<double, double>>& polygon_xz, double y0, double y1) {
  Ring near, far;
  Vec3d centre;
  for (const auto& [x, z] : polygon_xz) {
    near.push_back({x, y0, z});
    far.push_back({x, y1, z});
    centre += Vec3d{x, 0, z} * (1.0 / static_cast<double>(polygon_xz.size()));
  }
  loft(mesh, {near, far}, {centre.x, y0, centre.z}, {centre.x, y1, centre.z});
}

void box(TriangleMesh& mesh, const Vec3d& low, const Vec3d& high) {
  prism(mesh, {{low.x, low.z}, {high.x, low.z}, {high.x, high.z}, {low.x, high.z}}, low.y, high.y);
}

Ring circle(double x, double y, double z, double radius, int facets) {
  // Mean radius of a regular polygon of inner radius a over the angle: a (1/d) integral of 1/cos from 0 to d =
  // pi/facets = a (1 + d^2/6 + d^4/24 + ...).
  const double d = base::kPi / facets;
  const double vertexRadius = radius / (1 + d * d / 6 + d * d * d * d / 24) / base::cos(d);
  Ring ring;
  for (int i = 0; i < facets; ++i) {
    const double angle = 2 * base::kPi * i / facets;
    ring.push_back({x + vertexRadius * base::cos(angle), y, z + vertexRadius * base::sin(angle)});
  }
  return ring;
}

void lathe(TriangleMesh& mesh, const std::vector<std::pair<double, double>>& profile, double x, double z, int facets) {
  std::vector<Ring> rings;
  for (const auto& [y, radius] : profile) rings.push_back(circle(x, y, z, radius, facets));
  loft(mesh, rings, {x, profile.front().first, z}, {x, profile.back().first, z});
}

} // namespace grouser::assets
