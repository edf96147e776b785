// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/spec.hpp"

#include <functional>
#include <vector>

namespace grouser::vehicle {

/// Height of the undisturbed surface at (x, y), before vehicle contact [m].
using SurfaceHeight = std::function<double(double x, double y)>;

/// Tangent plane of the ground under a vehicle: least-squares plane through surface points below both tracks.
struct GroundPlane {
  double ahead = 0, left = 0; ///< slopes along the heading and to its left [-]; exactly 0 on level ground
  double height = 0;          ///< height of the plane at (x, y) of the vehicle origin [m]
  double highest = 0;         ///< largest elevation of a point above the plane [m]
  double top = 0;             ///< highest z of the points [m]
};

/// Fits the plane under a vehicle with its origin at (x, y) and the horizontal unit heading (c, s). The grid has 40
/// points along each track, to 0.2 m beyond the axles of first and last road wheel, and 5 across each pad; therefore
/// single grains have little effect on the plane.
GroundPlane groundPlane(const VehicleSpec& spec, double x, double y, double c, double s, const SurfaceHeight& surface);

} // namespace grouser::vehicle
