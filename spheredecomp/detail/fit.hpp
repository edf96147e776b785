// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "spheredecomp/detail/outer_surface.hpp"

namespace grouser::spheredecomp::detail {

using base::SetSphere;

/// How far a sphere may stand out of the mesh where it is fitted [radius].
inline constexpr double kFitTolerance = 0.005;

/// The sphere that stands for the surface at `point` with outward normal `normal`: `radius` deep under it; next to an
/// edge, as near to that as it lies inside; where the part is too thin, a smaller one, down to a fifth. `flat` and
/// `area` are left 0.
SetSphere fitSphere(const OuterSurface& outer, const Vec3d& point, const Vec3d& normal, double radius);

/// Greatest radius of a flat disc for the sphere [m], at most `limit`: at twelve points of its rim the inflated disc
/// stays within the mesh to `tolerance` [radius].
double flatRadius(const OuterSurface& outer, const SetSphere& sphere, double limit, double tolerance);

} // namespace grouser::spheredecomp::detail
