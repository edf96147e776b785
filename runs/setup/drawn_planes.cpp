// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/drawn_planes.hpp"

#include "runs/scene/scene.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace grouser::setup {

using base::Vec3d;

namespace {

/// Corners of a box that contains initial grains, cylinders and the points of planes, with a margin.
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

DrawnPlanes drawnPlanes(const scene::Scene& scene) {
  DrawnPlanes drawn;
  std::tie(drawn.low, drawn.high) = room(scene);
  for (const scene::Plane& p : scene.planes) {
    const Vec3d n = base::normalized(p.normal);
    drawn.planes.push_back({n, dot(n, p.point), p.isWall()});
  }
  return drawn;
}

} // namespace grouser::setup
