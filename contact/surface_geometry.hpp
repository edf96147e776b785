// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cmath>
#include <cstdint>

namespace grouser::contact {

/// Rigid surface shapes with a closed form for the nearest point. Each is centred at the origin of its own frame S.
enum class SurfaceShape : std::int32_t {
  plane,    ///< half-space z < 0
  box,      ///< solid, |x|, |y|, |z| <= half
  cylinder, ///< solid about the z axis, with flat ends
  tube,     ///< thin wall, rho = radius and |z| <= half: contact from inside and outside, open at both
            ///< ends
  capsule,  ///< solid: all points within radius of the segment x = y = 0, |z| <= half; a sphere if half is 0
  cone,     ///< solid about the z axis, truncated: its radius falls linearly from the base at z = -half to the tip at
            ///< z = half, with flat ends
};

/// Shape and size of a surface; constant.
struct SurfaceGeometry {
  SurfaceShape shape{};
  base::Vec3d half; ///< box: half of its edges; cylinder, tube: x the radius, z half of the length; capsule: x the
                    ///< radius, z half of the segment; cone: x the radius of the base, y that of the tip, not above x,
                    ///< z half of the length [m]
};

/// Distance from a point to the nearest point of a surface, with the direction of the gap.
struct SurfaceGap {
  base::Vec3d normal; ///< unit, out of the solid
  double distance;    ///< [m]; negative inside the solid
};

namespace detail {

GROUSER_HD SurfaceGap gapToBox(const base::Vec3d& half, const base::Vec3d& p) {
  base::Vec3d out;       // vector from the nearest point of the box, if p is outside
  double least = -1e300; // distance of the nearest face, if p is inside
  int face = 0;
  bool outside = false;
  for (int a = 0; a < 3; ++a) {
    const double beyond = fabs(p[a]) - half[a];
    if (beyond > least) least = beyond, face = a;
    if (beyond <= 0) continue;
    out[a] = p[a] < 0 ? -beyond : beyond;
    outside = true;
  }
  if (outside) {
    const double distance = norm(out);
    return {out * (1 / distance), distance};
  }
  base::Vec3d normal;
  normal[face] = p[face] < 0 ? -1 : 1;
  return {normal, least};
}

/// Gap to the rim of a round surface, from the distances to its wall (`side`) and to its end (`end`) in the plane that
/// contains the axis and the point.
GROUSER_HD SurfaceGap roundedGap(const base::Vec3d& across, double side, const base::Vec3d& along, double end) {
  const double distance = sqrt(side * side + end * end);
  if (!(distance > 0)) return {across, 0};
  return {(across * side + along * end) * (1 / distance), distance};
}

GROUSER_HD SurfaceGap gapToRound(const SurfaceGeometry& g, const base::Vec3d& p) {
  const double rho = sqrt(p.x * p.x + p.y * p.y);
  const base::Vec3d radial = rho > 0 ? base::Vec3d{p.x / rho, p.y / rho, 0} : base::Vec3d{1, 0, 0};
  const base::Vec3d along{0, 0, p.z < 0 ? -1.0 : 1.0};
  const double beyond = rho - g.half.x, end = fabs(p.z) - g.half.z;
  if (g.shape == SurfaceShape::tube) {
    const bool inside = beyond < 0;
    const base::Vec3d across = inside ? -radial : radial;
    const double side = inside ? -beyond : beyond;
    return end <= 0 ? SurfaceGap{across, side} : roundedGap(across, side, along, end);
  }
  if (beyond > 0 && end > 0) return roundedGap(radial, beyond, along, end);
  return beyond > end ? SurfaceGap{radial, beyond} : SurfaceGap{along, end};
}

GROUSER_HD SurfaceGap gapToCapsule(const base::Vec3d& half, const base::Vec3d& p) {
  const double z = p.z > half.z ? half.z : p.z < -half.z ? -half.z : p.z;
  const base::Vec3d apart{p.x, p.y, p.z - z};
  const double distance = norm(apart);
  if (!(distance > 0)) return {{1, 0, 0}, -half.x};
  return {apart * (1 / distance), distance - half.x};
}

/// The section of the cone through the point is a convex polygon: base, side from A = (R, -h) to B = (r, h), tip.
GROUSER_HD SurfaceGap gapToCone(const base::Vec3d& half, const base::Vec3d& p) {
  const double rho = sqrt(p.x * p.x + p.y * p.y);
  const base::Vec3d radial = rho > 0 ? base::Vec3d{p.x / rho, p.y / rho, 0} : base::Vec3d{1, 0, 0};
  const base::Vec3d up{0, 0, 1};
  const double narrowing = half.x - half.y, length = sqrt(narrowing * narrowing + 4 * half.z * half.z);
  const double nRho = 2 * half.z / length, nUp = narrowing / length; // normal of the side
  const double below = -half.z - p.z, above = p.z - half.z;
  const double beside = (rho - half.x) * nRho + (p.z + half.z) * nUp;
  const double along = (p.z + half.z) * nRho - (rho - half.x) * nUp; // distance from A along the side
  if (below > 0 && rho <= half.x) return {-up, below};
  if (above > 0 && rho <= half.y) return {up, above};
  if (below > 0 || above > 0 || beside > 0) {
    if (along <= 0) return roundedGap(radial, rho - half.x, -up, below);
    if (along >= length) return roundedGap(radial, rho - half.y, up, above);
    return {radial * nRho + up * nUp, beside};
  }
  if (beside >= below && beside >= above) return {radial * nRho + up * nUp, beside};
  return below > above ? SurfaceGap{-up, below} : SurfaceGap{up, above};
}

} // namespace detail

/// Exact gap; point and result in the surface frame.
GROUSER_HD SurfaceGap gapTo(const SurfaceGeometry& g, const base::Vec3d& p_S) {
  if (g.shape == SurfaceShape::plane) return {{0, 0, 1}, p_S.z};
  if (g.shape == SurfaceShape::box) return detail::gapToBox(g.half, p_S);
  if (g.shape == SurfaceShape::capsule) return detail::gapToCapsule(g.half, p_S);
  if (g.shape == SurfaceShape::cone) return detail::gapToCone(g.half, p_S);
  return detail::gapToRound(g, p_S);
}

/// Half edges [m] of the bounding box aligned with the surface frame; not defined for a plane.
inline base::Vec3d halfExtent(const SurfaceGeometry& g) {
  if (g.shape == SurfaceShape::box) return g.half;
  return {g.half.x, g.half.x, g.half.z + (g.shape == SurfaceShape::capsule ? g.half.x : 0)};
}

/// Minimum half extent of a bounded shape [m].
inline double thinnest(const SurfaceGeometry& g) {
  const base::Vec3d half = halfExtent(g);
  return fmin(half.x, fmin(half.y, half.z));
}

/// Support function: largest p . d over the points p of a surface [m]; d: unit vector in its frame. Not for planes.
inline double farthestAlong(const SurfaceGeometry& g, const base::Vec3d& d) {
  const double up = fabs(d.z) * g.half.z, across = sqrt(d.x * d.x + d.y * d.y);
  if (g.shape == SurfaceShape::box) return fabs(d.x) * g.half.x + fabs(d.y) * g.half.y + up;
  if (g.shape == SurfaceShape::capsule) return g.half.x + up;
  if (g.shape != SurfaceShape::cone) return across * g.half.x + up;
  const double base = across * g.half.x - d.z * g.half.z, tip = across * g.half.y + d.z * g.half.z;
  return base > tip ? base : tip;
}

} // namespace grouser::contact
