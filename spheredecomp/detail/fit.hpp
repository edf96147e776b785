// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "spheredecomp/detail/outer_surface.hpp"

namespace grouser::spheredecomp::detail {

using base::SetSphere;

/// Largest protrusion of a fitted sphere [radius].
inline constexpr double kFitTolerance = 0.005;

/// Limits and method of a sphere fit.
struct Fit {
  double smallest; ///< [radius]
  bool touching;   ///< true: largest sphere that touches the surface at the point; false: largest that fits nearby, by
                   ///< bisection
};

/// The sphere for the surface at `point` with outward normal `normal`: `radius` deep under it; next to an edge, as near
/// to that as it lies inside; if the part is too thin, a smaller one, down to `fit.smallest`. `flat` and `area` stay 0.
SetSphere fitSphere(const OuterSurface& outer, const Vec3d& point, const Vec3d& normal, double radius, const Fit& fit);

/// Greatest radius of a flat disc for the sphere [m], at most `limit`: at twelve points of its rim the inflated disc
/// stays within the mesh to `tolerance` [radius]. `closely`: at twice as many points, and of all rings within the rim,
/// so that no disc covers a small hole.
double flatRadius(const OuterSurface& outer, const SetSphere& sphere, double limit, double tolerance, bool closely);

} // namespace grouser::spheredecomp::detail
