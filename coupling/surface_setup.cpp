// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/surface_setup.hpp"

#include "base/rounded.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace grouser::coupling {

using base::Vec3d;

terrain::SurfacePose startingPose(const SurfaceSetup& surface) {
  const base::Pose& pose = surface.start;
  return {{pose.position, pose.orientation.matrix(), pose.position, {}, {}}, base::Mat3d::identity()};
}

double startingOverlap(const SurfaceSetup& surface, const Vec3d& position, double radius) {
  return overlapAt(surface, surface.start, position, radius);
}

double overlapAt(const SurfaceSetup& surface, const base::Pose& pose, const Vec3d& position, double radius) {
  const Vec3d p = pose.toBody(position);
  if (surface.mesh) return radius - surface.mesh->signedDistance(p);
  return radius - terrain::gapTo(surface.geometry, p).distance;
}

namespace {

/// Extent of a surface along an axis of the world [m].
std::array<double, 2> extentAlong(int axis, const SurfaceSetup& surface, const base::Pose& pose) {
  const double middle = pose.position[axis];
  const Vec3d& half = surface.geometry.half;
  const base::Mat3d turned = pose.orientation.matrix();
  if (surface.mesh) {
    std::array<double, 2> reach{1e300, -1e300};
    for (const Vec3d& v : surface.mesh->mesh().vertices) {
      const double at = pose.toWorld(v)[axis];
      reach = {std::min(reach[0], at), std::max(reach[1], at)};
    }
    return reach;
  }
  double reach = 0;
  if (surface.geometry.shape == terrain::SurfaceShape::box) {
    for (int k = 0; k < 3; ++k) reach += std::fabs(turned.m[axis][k]) * half[k];
  } else {
    const double along = turned.m[axis][2];
    reach = std::fabs(along) * half.z + std::sqrt(std::max(0.0, 1 - along * along)) * half.x;
  }
  return {middle - reach, middle + reach};
}

} // namespace

void SurfaceSetup::lift(double way) {
  start.position.z += way;
  motion.lift(way);
}

SurfaceBounds boundsOf(const SurfaceSetup& surface, const base::Pose& pose) {
  SurfaceBounds bounds;
  for (int a = 0; a < 3; ++a) {
    const auto [low, high] = extentAlong(a, surface, pose);
    bounds.low[a] = low, bounds.high[a] = high;
  }
  return bounds;
}

std::string faultAtBoundaries(const SurfaceSetup& surface, const base::Pose& pose,
                              const terrain::PeriodicBoundaries& sides, double radius) {
  if (surface.geometry.shape == terrain::SurfaceShape::plane) return "";
  for (std::size_t a = 0; a < 2; ++a) {
    if (!sides[a]) continue;
    const auto [from, to] = *sides[a];
    const auto [low, high] = extentAlong(static_cast<int>(a), surface, pose);
    const double rounding = 1e-9 * (to - from);
    const bool inside = low >= from + radius - rounding && high <= to - radius + rounding;
    const bool across = low <= from + rounding && high >= to - rounding;
    if (inside || across) continue;
    return fmt::format(
        "reaches from {0} = {1:.6g} to {2:.6g} m, into a periodic boundary, across which surfaces have no image: "
        "keep it between {0} = {3} and {4} m, a radius of the largest grain from the boundaries, or extend it "
        "across both, from {5:g} to {6:g} m",
        "xy"[a], low, high, base::roundedUp(from + radius, 6), base::roundedDown(to - radius, 6), from, to);
  }
  return "";
}

} // namespace grouser::coupling
