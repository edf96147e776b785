// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"
#include "contact/part_motion.hpp"
#include "contact/surface_geometry.hpp"

#include <cmath>
#include <cstdint>

namespace grouser::terrain {

using contact::gapTo;
using contact::SurfaceGap;
using contact::SurfaceGeometry;
using contact::SurfaceShape;

/// Pose and motion of a surface in one step. `motion.origin` and `motion.centre` are the same point, the reference
/// point of loads.
struct SurfacePose {
  contact::PartMotion motion;                   ///< frame S in the world, velocity and spin
  base::Mat3d turned = base::Mat3d::identity(); ///< since the start, in world components: springs turn with the surface
  // Force-driven surfaces: complementarity contacts solve for their speed too.
  base::Vec3d axis{};   ///< unit vector along which it is free; zero: prescribed motion
  double inverseMass{}; ///< [1/kg]
  double gains{};       ///< change of speed along `axis` by load and gravity in this step [m/s]

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

/// Travel of a surface between two poses, without motions along itself: a sliding plane, a cylinder rotating about its
/// axis. The distance of a point p from the surface changes by at most way + turn |p - centre before|.
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

/// Travel of a surface before grains near it are listed again, for an allowed `way` [m].
GROUSER_HD SurfaceTravel roomOf(const SurfaceGeometry& g, double way) {
  const double extent = norm(g.half);
  return {way, extent > 0 ? way / extent : 0.01};
}

} // namespace grouser::terrain
