// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace grouser::coupling {

using base::Vec3d;

namespace {

constexpr double kNoTop = -std::numeric_limits<double>::infinity();
constexpr double kOnGround = 0.05; // [m]

/// Intersects [low, high] of a vertical line with the slab |p + t d| <= half along one axis.
void cutSlab(double p, double d, double half, double& low, double& high) {
  if (d == 0) {
    if (std::fabs(p) > half) low = 1, high = 0;
    return;
  }
  const double a = (-half - p) / d, b = (half - p) / d;
  low = std::max(low, std::min(a, b)), high = std::min(high, std::max(a, b));
}

/// Same for a cylinder about the z axis.
void cutRound(const Vec3d& p, const Vec3d& d, double radius, double& low, double& high) {
  const double a = d.x * d.x + d.y * d.y, b = p.x * d.x + p.y * d.y, c = p.x * p.x + p.y * p.y - radius * radius;
  if (a < 1e-12) {
    if (c > 0) low = 1, high = 0;
    return;
  }
  const double root = b * b - a * c;
  if (root < 0) {
    low = 1, high = 0;
    return;
  }
  const double half = std::sqrt(root);
  low = std::max(low, (-b - half) / a), high = std::min(high, (-b + half) / a);
}

double topOfMesh(const SurfaceSetup& surface, double x, double y) {
  const spheredecomp::TriangleMesh& mesh = surface.mesh->mesh();
  double top = kNoTop;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    Vec3d v[3];
    for (std::size_t k = 0; k < 3; ++k) v[k] = surface.start.toWorld(mesh.vertices[mesh.indices[t + k]]);
    // Barycentric coordinates of (x, y) in the triangle seen from above.
    const double area = (v[1].x - v[0].x) * (v[2].y - v[0].y) - (v[2].x - v[0].x) * (v[1].y - v[0].y);
    if (!(area > 0)) continue; // faces downward, or is vertical
    const double s = ((x - v[0].x) * (v[2].y - v[0].y) - (v[2].x - v[0].x) * (y - v[0].y)) / area;
    const double u = ((v[1].x - v[0].x) * (y - v[0].y) - (x - v[0].x) * (v[1].y - v[0].y)) / area;
    if (s >= 0 && u >= 0 && s + u <= 1) top = std::max(top, v[0].z + s * (v[1].z - v[0].z) + u * (v[2].z - v[0].z));
  }
  return top;
}

} // namespace

double topOf(const SurfaceSetup& surface, double x, double y) {
  if (surface.mesh) return topOfMesh(surface, x, y);
  const base::Mat3d turned = surface.start.orientation.matrix();
  const Vec3d d{turned.m[2][0], turned.m[2][1], turned.m[2][2]}; // upward direction in the surface frame
  const Vec3d p = surface.start.toBody({x, y, 0});
  const Vec3d& half = surface.geometry.half;
  double low = kNoTop, high = -kNoTop;
  switch (surface.geometry.shape) {
  case terrain::SurfaceShape::plane:
    return d.z > 1e-9 ? -p.z / d.z : kNoTop;
  case terrain::SurfaceShape::box:
    for (int a = 0; a < 3; ++a) cutSlab(p[a], d[a], half[a], low, high);
    break;
  case terrain::SurfaceShape::cylinder:
    cutSlab(p.z, d.z, half.z, low, high), cutRound(p, d, half.x, low, high);
    break;
  case terrain::SurfaceShape::tube:
  case terrain::SurfaceShape::capsule: // this and the next: bodies only
  case terrain::SurfaceShape::cone:
    return kNoTop;
  }
  if (low > high) return kNoTop;
  return high;
}

std::function<double(double, double)> withObstacles(const std::function<double(double, double)>& ground,
                                                    const std::vector<Obstacle>& obstacles) {
  if (!ground || obstacles.empty()) return ground;
  const auto standing = std::make_shared<std::vector<SurfaceSetup>>();
  for (const Obstacle& o : obstacles) {
    const Vec3d& middle = o.surface.start.position;
    if (o.surface.geometry.shape == terrain::SurfaceShape::plane ||
        boundsOf(o.surface, o.surface.start).low.z <= ground(middle.x, middle.y) + kOnGround)
      standing->push_back(o.surface);
  }
  return [ground, standing](double x, double y) {
    double height = ground(x, y);
    for (const SurfaceSetup& s : *standing) height = std::max(height, topOf(s, x, y));
    return height;
  };
}

} // namespace grouser::coupling
