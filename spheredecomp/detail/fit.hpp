// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "spheredecomp/detail/outer_surface.hpp"

namespace grouser::spheredecomp::detail {

using base::SetSphere;

/// Maximum protrusion of a fitted sphere [radius].
inline constexpr double kFitTolerance = 0.005;

/// Limits and method of a sphere fit.
struct Fit {
  double smallest; ///< [radius]
  bool touching;   ///< true: largest sphere tangent to the surface at the point; false: largest sphere that fits
                   ///< nearby, found by bisection
};

/// Fits a sphere below the surface at `point` with outward normal `normal`: at a depth of `radius`, or next to an edge
/// as close to this depth as the sphere fits. If the part is too thin, the sphere is smaller, down to `fit.smallest`.
/// `flat` and `area` remain 0.
SetSphere fitSphere(const OuterSurface& outer, const Vec3d& point, const Vec3d& normal, double radius, const Fit& fit);

/// Maximum radius of a flat disc for the sphere [m], at most `limit`, for which the inflated disc stays within the mesh
/// to `tolerance` [radius] at twelve points of its rim. `closely`: tests twice as many points, on all inner rings too,
/// so that no disc covers a small hole.
double flatRadius(const OuterSurface& outer, const SetSphere& sphere, double limit, double tolerance, bool closely);

} // namespace grouser::spheredecomp::detail
