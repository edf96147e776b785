// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/plane_mesh.hpp"

#include <algorithm>
#include <vector>

namespace grouser::output {

using base::Vec3d;

namespace {

struct HalfSpace {
  Vec3d normal; ///< unit vector
  double offset;
};

/// Part of a convex polygon at normal . x >= offset (Sutherland and Hodgman).
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

constexpr double kFloor = 0.9;      ///< minimum z of the normal of a floor
constexpr double kFarOverRoom = 12; ///< extent of a floor beyond the drawn box / box diagonal; outside all views

bool isFloor(const setup::DrawnPlanes::Plane& plane) { return plane.normal.z > kFloor; }

base::TriangleMesh meshOf(const setup::DrawnPlanes& drawn, const std::vector<std::size_t>& planes, bool far = false) {
  base::TriangleMesh mesh;
  if (planes.empty()) return mesh;
  const auto& [all, narrowLow, narrowHigh] = drawn;
  const double reach = far ? kFarOverRoom * norm(narrowHigh - narrowLow) : 0;
  const Vec3d low = narrowLow - Vec3d{reach, reach, 0}, high = narrowHigh + Vec3d{reach, reach, 0};
  std::vector<HalfSpace> spaces;
  for (const setup::DrawnPlanes::Plane& p : all) spaces.push_back({p.normal, p.offset});
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
    const double outside = 4 * norm(high - low) + norm(middle) + norm(high) + norm(low);
    std::vector<Vec3d> polygon{middle + (along + across) * outside, middle + (across - along) * outside,
                               middle - (along + across) * outside, middle + (along - across) * outside};
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

base::TriangleMesh planeMesh(const setup::DrawnPlanes& drawn) {
  std::vector<std::size_t> walls;
  for (std::size_t k = 0; k < drawn.planes.size(); ++k)
    if (drawn.planes[k].wall) walls.push_back(k);
  return meshOf(drawn, walls);
}

base::TriangleMesh planeMesh(const setup::DrawnPlanes& drawn, std::size_t plane) { return meshOf(drawn, {plane}); }

base::TriangleMesh floorMesh(const setup::DrawnPlanes& drawn) {
  std::vector<std::size_t> floors;
  for (std::size_t k = 0; k < drawn.planes.size(); ++k)
    if (drawn.planes[k].wall && isFloor(drawn.planes[k])) floors.push_back(k);
  return meshOf(drawn, floors, true);
}

base::TriangleMesh floorMesh(const setup::DrawnPlanes& drawn, std::size_t plane) {
  return meshOf(drawn, {plane}, isFloor(drawn.planes[plane]));
}

} // namespace grouser::output
