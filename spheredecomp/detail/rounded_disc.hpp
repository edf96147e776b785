// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"

namespace grouser::spheredecomp::detail {

using base::SetSphere;
using base::Vec3d;

/// Distance from p to the rounded disc of a sphere [m], negative inside; see SetSphere.
inline double discDistance(const SetSphere& s, const Vec3d& p) {
  const Vec3d v = p - s.centre;
  const double along = dot(v, s.normal);
  const Vec3d across = v - s.normal * along;
  const double length = norm(across);
  if (length <= s.flat) return (along < 0 ? -along : along) - s.radius;
  const double beyond = length - s.flat;
  return sqrt(beyond * beyond + along * along) - s.radius;
}

/// Distance from p to the sphere without its disc [m].
inline double ballDistance(const SetSphere& s, const Vec3d& p) { return norm(p - s.centre) - s.radius; }

} // namespace grouser::spheredecomp::detail
