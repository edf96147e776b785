// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/spec.hpp"

#include <functional>
#include <vector>

namespace grouser::vehicle {

/// Height of the undisturbed surface at (x, y), before the vehicle touched it [m].
using SurfaceHeight = std::function<double(double x, double y)>;

/// Tangent plane of the ground under a vehicle: least-squares plane through surface points under both tracks.
struct GroundPlane {
  double ahead = 0, left = 0; ///< slopes along the heading and to its left [-]; exactly 0 on level ground
  double height = 0;          ///< under the vehicle's origin [m]
  double highest = 0;         ///< highest point above the plane [m]
  double top = 0;             ///< highest z of the points [m]
};

/// Under a vehicle with its origin at (x, y) and the heading (c, s), a level unit vector. The points lie 40 to a length
/// that reaches 0.2 m beyond the axles of first and last road wheel, and 5 across each pad: grains, which are much
/// smaller, hardly tilt it.
GroundPlane groundPlane(const VehicleSpec& spec, double x, double y, double c, double s, const SurfaceHeight& surface);

} // namespace grouser::vehicle
