// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"
#include "contact/part_motion.hpp"

#include <cmath>
#include <cstdint>

namespace grouser::terrain {

/// Shapes of rigid surfaces whose nearest point has a closed form. Each lies about the origin of its own frame S.
enum class SurfaceShape : std::int32_t {
  plane,    ///< solid below z = 0, without end
  box,      ///< solid, |x|, |y|, |z| <= half
  cylinder, ///< solid about the z axis, with flat ends
  tube, ///< a wall without thickness, rho = radius and |z| <= half: in contact from inside and outside, open at both
        ///< ends
};

/// Shape and size, the same for ever.
struct SurfaceGeometry {
  SurfaceShape shape{};
  base::Vec3d half; ///< box: half of its edges; cylinder and tube: x the radius, z half of the length [m]
};

/// Where a surface is and how it moves in one step. `motion.origin` and `motion.centre` are one point, about which
/// loads are taken.
struct SurfacePose {
  contact::PartMotion motion;                   ///< frame S in the world, velocity and spin
  base::Mat3d turned = base::Mat3d::identity(); ///< since the start, in world components: springs turn with the surface

  /// The z axis of the surface's frame, in the world: out of a plane, along a cylinder.
  GROUSER_HD base::Vec3d normal() const {
    return {motion.rotation.m[0][2], motion.rotation.m[1][2], motion.rotation.m[2][2]};
  }
};

/// One of the surfaces of a scene.
struct RigidSurface {
  SurfaceGeometry geometry;
  contact::ContactLaw law; ///< between grain and surface
  SurfacePose start;
};

/// Load that the grains put on a surface in one step, about its centre.
struct SurfaceLoad {
  base::Vec3d force, torque; ///< [N], [N m]
};

/// Distance from a point to the nearest point of a surface, and the direction there.
struct SurfaceGap {
  base::Vec3d normal; ///< unit, out of the solid
  double distance;    ///< [m]; negative within the solid
};

namespace detail {

GROUSER_HD SurfaceGap gapToBox(const base::Vec3d& half, const base::Vec3d& p) {
  base::Vec3d out;       // from the nearest point of the box, where p is outside
  double least = -1e300; // the shallowest face, where it is within
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

/// Of the meridian: `side` across to the wall, `end` along the axis to the end.
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

} // namespace detail

/// Exact; both in the surface's frame.
GROUSER_HD SurfaceGap gapTo(const SurfaceGeometry& g, const base::Vec3d& p_S) {
  if (g.shape == SurfaceShape::plane) return {{0, 0, 1}, p_S.z};
  if (g.shape == SurfaceShape::box) return detail::gapToBox(g.half, p_S);
  return detail::gapToRound(g, p_S);
}

/// How far a surface has come between two placements, without what leaves it where it was: a plane that slides along
/// itself, a cylinder that turns about its axis. The distance of a point p from the surface has changed by no more than
/// way + turn |p - centre before|.
struct SurfaceTravel {
  double way{}, turn{}; ///< [m], [-]
};

/// In the frame of a rigid body p moves by no more than |shift of the centre| + |I - Q| |p - centre|, Q the turn; |I -
/// Q| is the chord 2 sin(angle / 2), of an axis alone the distance between its two ends.
inline SurfaceTravel travelBetween(const SurfaceGeometry& g, const SurfacePose& a, const SurfacePose& b) {
  const auto chordOf = [&](int column) {
    base::Vec3d chord;
    for (int row = 0; row < 3; ++row) chord[row] = b.motion.rotation.m[row][column] - a.motion.rotation.m[row][column];
    return norm(chord);
  };
  const base::Vec3d shift = b.motion.centre - a.motion.centre;
  const double tilt = chordOf(2);
  switch (g.shape) {
  case SurfaceShape::plane:
    return {std::fabs(dot(a.normal(), shift)) + tilt * norm(shift), tilt};
  case SurfaceShape::box:
    return {norm(shift), chordOf(0) + chordOf(1) + tilt};
  default:
    return {norm(shift), tilt};
  }
}

/// What a surface may travel before grains near it are listed anew, where `way` [m] is allowed.
GROUSER_HD SurfaceTravel roomOf(const SurfaceGeometry& g, double way) {
  const double extent = norm(g.half);
  return {way, extent > 0 ? way / extent : 0.01};
}

} // namespace grouser::terrain
