// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/spec.hpp"

#include <vector>

/// Upper bound of the step height that a vehicle can climb, from its geometry.
namespace grouser::events {

inline constexpr double kGravity = 9.81; ///< default gravity of the events, and the unit g of accelerations [m/s2]

/// Point in the side view: x forward from the sprocket axle, z up [m].
struct SidePoint {
  double x = 0, z = 0;
};

/// Disc in the side view, enclosed by a track.
struct SideDisc {
  SidePoint middle;
  double radius = 0; ///< [m]
};

/// Length of the shortest loop around discs [m] that passes above `notch`. A notch outside the loop has no effect. The
/// discs are replaced by inscribed polygons of 96 corners: a lower bound, too short by at most 2e-4 of the arcs.
double shortestLoop(const std::vector<SideDisc>& discs);
double shortestLoop(const std::vector<SideDisc>& discs, const SidePoint& notch);

/// Height above which no slow vehicle climbs a step at any friction [m].
///
/// When the centre of mass of a slow vehicle passes over the edge of a step, the ground behind the edge must still
/// support the vehicle, or it tips back. The bound is therefore the maximum height of the edge above the lowest track
/// point, over all pitch angles, with the edge vertically below the centre of mass, where
/// - the edge is outside the hull, and under the contact length no higher than an arm turned by half the weight allows,
///   or two arms turned by a quarter each with shoes folded up between them;
/// - the track encloses sprocket, idler (at its inner stop) and the lowest wheel, passes above the edge, and is at most
///   as long as its shoes;
/// - the lowest wheel hangs on its arm as far as the loop and the unloaded torsion bar allow; other wheels are free;
///   rigid arms keep their angle, and their wheels keep the edge out;
/// - wheels, arms and shoes shift the centre of mass as far forward and down as possible.
/// Each assumption favours the vehicle, so this is an upper bound. `gravity` [m/s2]. Throws base::InputError if the
/// track does not close or the hull mesh cannot be read.
double highestStep(const vehicle::VehicleSpec& spec, double gravity);

} // namespace grouser::events
