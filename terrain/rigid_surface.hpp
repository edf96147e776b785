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
/// point of the loads.
struct SurfacePose {
  contact::PartMotion motion;                   ///< frame S in the world, velocity and spin
  base::Mat3d turned = base::Mat3d::identity(); ///< rotation since the start, world components; springs rotate along
  // Force-driven surfaces: complementarity contacts also solve for their speed.
  base::Vec3d axis{};   ///< unit vector of the free direction; zero: prescribed motion
  double inverseMass{}; ///< [1/kg]
  double gains{};       ///< speed change along `axis` by load and gravity in this step [m/s]

  /// The z axis of the surface frame in the world: normal of a plane, axis of a cylinder.
  GROUSER_HD base::Vec3d normal() const {
    return {motion.rotation.m[0][2], motion.rotation.m[1][2], motion.rotation.m[2][2]};
  }
};

/// Rigid surface of a scene.
struct RigidSurface {
  SurfaceGeometry geometry;
  contact::ContactLaw law; ///< grain-surface law
  SurfacePose start;
};

/// Load of the grains on a surface in one step, about its centre.
struct SurfaceLoad {
  base::Vec3d force, torque; ///< [N], [N m]
};

/// Travel of a surface between two poses, excluding motion along itself: a sliding plane, a cylinder rotating about its
/// axis. The distance of a point p from the surface changes by at most way + turn |p - centre before|.
struct SurfaceTravel {
  double way{}, turn{}; ///< [m], [-]
};

/// In the body frame p moves by at most |shift of the centre| + |I - Q| |p - centre|, Q the rotation; |I - Q| is the
/// chord 2 sin(angle / 2), and for a single axis the distance between its two directions.
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

/// Allowed travel of a surface between two lists of nearby grains, for a maximum displacement `way` [m].
GROUSER_HD SurfaceTravel roomOf(const SurfaceGeometry& g, double way) {
  const double extent = norm(g.half);
  return {way, extent > 0 ? way / extent : 0.01};
}

} // namespace grouser::terrain
