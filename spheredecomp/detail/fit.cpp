// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/detail/fit.hpp"

#include "base/math.hpp"

#include <algorithm>

namespace grouser::spheredecomp::detail {
namespace {

constexpr int kPushes = 12;
constexpr int kHalvings = 5;
constexpr int kShrinks = 30;
constexpr int kDirections = 12;
constexpr int kFlatSteps = 10;

/// If two pushes return to within this distance of the start, but one push does not, the iteration is a cycle [radius].
constexpr double kCycle = 0.01;

/// Moves `centre` repeatedly away from the nearest surface point until a sphere of `radius` is inside (successive
/// projection onto half-spaces). Returns false if this does not converge, as between two faces of a thin plate.
bool push(const OuterSurface& outer, Vec3d& centre, const Vec3d& normal, double radius) {
  Vec3d before = centre, beforeThat = centre + normal * radius;
  for (int i = 0; i < kPushes; ++i) {
    const bool inside = outer.solid().inside(centre);
    const ClosestPoint near =
        inside ? outer.surface().closest(centre, radius * (1 - kFitTolerance)) : outer.surface().closest(centre);
    if (near.triangle == kNone) return true;
    const Vec3d away = inside ? centre - near.point : near.point - centre;
    const double length = norm(away);
    centre = near.point + (length > 0 ? away * (radius / length) : normal * -radius);
    const double back2 = kCycle * kCycle * radius * radius;
    if (i > 1 && norm2(centre - beforeThat) < back2 && norm2(centre - before) > 25 * back2) return false;
    beforeThat = before;
    before = centre;
  }
  return false;
}

/// Radius, at most `radius`, of the largest ball inside the mesh that touches the surface at `point`: the ball shrinks
/// to the nearest surface point until no surface point is inside (Ma, Bae and Choi 2012, shrinking ball).
double touchingRadius(const OuterSurface& outer, const Vec3d& point, const Vec3d& normal, double radius) {
  double r = radius;
  for (int i = 0; i < kShrinks; ++i) {
    const ClosestPoint near = outer.surface().closest(point - normal * r, r * (1 - 1e-4));
    if (near.triangle == kNone) break;
    const Vec3d apart = point - near.point;
    const double along = dot(apart, normal);
    if (!(along > 0)) break;
    r = norm2(apart) / (2 * along);
  }
  return r;
}

} // namespace

SetSphere fitSphere(const OuterSurface& outer, const Vec3d& point, const Vec3d& normal, double radius, const Fit& fit) {
  SetSphere sphere;
  sphere.normal = normal;
  sphere.offset = dot(normal, point);
  auto fits = [&](double r) {
    Vec3d centre = point - normal * r;
    if (!push(outer, centre, normal, r)) return false;
    sphere.centre = centre;
    sphere.radius = r;
    return true;
  };
  if (fits(radius)) return sphere;

  // The part is too thin for the full sphere: find the largest sphere that fits by bisection.
  double low = fit.smallest * radius, high = radius;
  if (fit.touching && fits(std::max(low, touchingRadius(outer, point, normal, radius)))) return sphere;
  if (!fits(low)) {
    sphere.centre = point - normal * low;
    sphere.radius = low;
    return sphere;
  }
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (fits(middle) ? low : high) = middle;
  }
  return sphere;
}

double flatRadius(const OuterSurface& outer, const SetSphere& sphere, double limit, double tolerance, bool closely) {
  const Vec3d& n = sphere.normal;
  const Vec3d other = n.x * n.x < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d u = normalized(cross(n, other)), v = cross(n, u);
  const double clearance = sphere.radius * (1 - tolerance);
  auto stays = [&](double t) {
    const int directions = closely ? 2 * kDirections : kDirections;
    for (int k = 0; k < directions; ++k) {
      const double angle = 2 * base::kPi * k / directions;
      const Vec3d p = sphere.centre + u * (t * base::cos(angle)) + v * (t * base::sin(angle));
      if (outer.surface().within(p, clearance) || !outer.solid().inside(p)) return false;
    }
    return true;
  };
  // A small hole may be inside a valid rim.
  const bool whole = stays(limit) && (!closely || (stays(0.75 * limit) && stays(0.5 * limit) && stays(0.25 * limit)));
  if (whole) return limit;
  double flat = 0;
  for (int i = 1; i < kFlatSteps; ++i) {
    const double t = limit * i / kFlatSteps;
    if (!stays(t)) break;
    flat = t;
  }
  return flat;
}

} // namespace grouser::spheredecomp::detail
