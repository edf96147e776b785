// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/plane_mesh.hpp"

#include <algorithm>
#include <vector>

namespace grouser::output {

using base::Vec3d;

namespace {

struct HalfSpace {
  Vec3d normal; ///< unit
  double offset;
};

/// What of a convex polygon lies at normal . x >= offset (Sutherland and Hodgman).
std::vector<Vec3d> clipped(const std::vector<Vec3d>& polygon, const HalfSpace& h) {
  std::vector<Vec3d> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = dot(h.normal, a) - h.offset, db = dot(h.normal, b) - h.offset;
    if (da >= 0) kept.push_back(a);
    if ((da >= 0) != (db >= 0)) kept.push_back(a + (b - a) * (da / (da - db)));
  }
  return kept;
}

/// Corners of a box that holds where grains start, the planes' points, cylinders, and some room.
std::pair<Vec3d, Vec3d> room(const scene::Scene& scene) {
  std::vector<Vec3d> points;
  double margin = 0;
  for (const scene::Grain& g : scene.grains) points.push_back(g.position), margin = std::max(margin, 4 * g.radius);
  for (const scene::GrainFill& b : scene.fills) {
    for (const scene::Grain& g : b.fromFile) points.push_back(g.position);
    if (b.low) points.push_back(*b.low), points.push_back(*b.high);
    margin = std::max(margin, 4 * b.largestRadius());
  }
  for (const scene::Source& s : scene.sources)
    points.push_back(s.low), points.push_back(s.high), margin = std::max(margin, 4 * s.radius);
  for (const scene::Plane& p : scene.planes) points.push_back(p.point);
  for (const scene::CylinderSection& c : scene.cylinders)
    for (const double side : {-c.radius, c.radius}) points.push_back(c.position + Vec3d{side, side, side});
  if (points.empty()) points.push_back({});
  Vec3d low = points.front(), high = low;
  for (const Vec3d& p : points) low = base::min(low, p), high = base::max(high, p);
  const Vec3d size = high - low;
  const double spare = std::max(margin, 0.15 * std::max({size.x, size.y, size.z}));
  return {low - Vec3d{spare, spare, spare}, high + Vec3d{spare, spare, 0}};
}

} // namespace

namespace {

base::TriangleMesh meshOf(const scene::Scene& scene, const std::vector<std::size_t>& planes) {
  base::TriangleMesh mesh;
  if (planes.empty()) return mesh;
  const auto [low, high] = room(scene);
  std::vector<HalfSpace> spaces;
  for (const scene::Plane& p : scene.planes) {
    const Vec3d n = base::normalized(p.normal);
    spaces.push_back({n, dot(n, p.point)});
  }
  for (int a = 0; a < 3; ++a) {
    Vec3d n{};
    n[a] = 1;
    spaces.push_back({n, low[a]});
    spaces.push_back({-n, -high[a]});
  }
  for (const std::size_t k : planes) {
    const Vec3d n = spaces[k].normal,
                along = base::normalized(cross(n, std::abs(n.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0}));
    const Vec3d across = cross(n, along), middle = n * spaces[k].offset;
    const double far = 4 * norm(high - low) + norm(middle) + norm(high) + norm(low);
    std::vector<Vec3d> polygon{middle + (along + across) * far, middle + (across - along) * far,
                               middle - (along + across) * far, middle + (along - across) * far};
    for (std::size_t other = 0; other < spaces.size(); ++other)
      if (other != k) polygon = clipped(polygon, spaces[other]);
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(polygon[0]), mesh.vertices.push_back(polygon[i - 1]), mesh.vertices.push_back(polygon[i]);
      for (const std::uint32_t v : {0u, 1u, 2u}) mesh.indices.push_back(first + v);
    }
  }
  return mesh;
}

} // namespace

base::TriangleMesh planeMesh(const scene::Scene& scene) {
  std::vector<std::size_t> walls;
  for (std::size_t k = 0; k < scene.planes.size(); ++k)
    if (scene.planes[k].isWall()) walls.push_back(k);
  return meshOf(scene, walls);
}

base::TriangleMesh planeMesh(const scene::Scene& scene, std::size_t plane) { return meshOf(scene, {plane}); }

} // namespace grouser::output
