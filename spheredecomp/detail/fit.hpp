// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "spheredecomp/detail/outer_surface.hpp"

namespace grouser::spheredecomp::detail {

using base::SetSphere;

/// How far a sphere may stand out of the mesh where it is fitted [radius].
inline constexpr double kFitTolerance = 0.005;

/// How far a sphere may shrink, and how its radius is found.
struct Fit {
  double smallest; ///< [radius]
  bool touching; ///< exactly, as the largest that touches the surface at the point; else by halving, as it fits nearby
};

/// The sphere that stands for the surface at `point` with outward normal `normal`: `radius` deep under it; next to an
/// edge, as near to that as it lies inside; where the part is too thin, a smaller one, down to `fit.smallest`. `flat`
/// and `area` are left 0.
SetSphere fitSphere(const OuterSurface& outer, const Vec3d& point, const Vec3d& normal, double radius, const Fit& fit);

/// Greatest radius of a flat disc for the sphere [m], at most `limit`: at twelve points of its rim the inflated disc
/// stays within the mesh to `tolerance` [radius]. `closely`: at twice as many points, and of all rings within the rim,
/// so that no disc covers a small hole.
double flatRadius(const OuterSurface& outer, const SetSphere& sphere, double limit, double tolerance, bool closely);

} // namespace grouser::spheredecomp::detail
