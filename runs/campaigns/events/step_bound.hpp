// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/spec.hpp"

#include <vector>

/// The highest step that a vehicle can climb by its shape, its wheels free to move on their arms.
namespace grouser::events {

inline constexpr double kGravity = 9.81; ///< of the events' scenes [m/s2]

/// A point in the side view: x forward from the sprockets' axle, z up [m].
struct SidePoint {
  double x = 0, z = 0;
};

/// A disc in the side view, about which a track lies.
struct SideDisc {
  SidePoint middle;
  double radius = 0; ///< [m]
};

/// Length of the shortest loop about discs [m]; of `notch` the loop passes above: pressed in from below where the point
/// lies inside the loop, and no matter where it lies outside. Discs are cut to polygons of 96 corners on their rims, so
/// that it is never longer than it is, and shorter by 2e-4 of the arcs at most.
double shortestLoop(const std::vector<SideDisc>& discs);
double shortestLoop(const std::vector<SideDisc>& discs, const SidePoint& notch);

/// Above which no slow vehicle climbs a step, whatever its grip [m].
///
/// A slow vehicle whose centre of mass is about to pass over a step's edge still stands on the ground behind it: on
/// nothing but the edge and what lies beyond it would tip back. So the step is no higher than the edge can lie over the
/// lowest point of the track, at any pitch, with the edge straight below the centre of mass. There
/// - the edge is not within the hull, and no higher under the ground run than half of the weight, all of it that a
/// track
///   bears, turns the arm of one wheel, or a quarter those of two wheels with shoes folded up between them;
/// - the track goes round sprocket, idler and the wheel that is lowest, and above the edge; its pins' loop is no longer
///   than its shoes are, the idler pushed back to its stop;
/// - the wheel that is lowest hangs on its arm, which turns as far as that loop lets it and until its bar is unloaded;
///   all others are wherever they want to be; rigid arms stay as drawn, and wheels on them keep the edge out;
/// - wheels, arms and shoes may move the centre of mass as far forward and down as they can.
/// Each of these leaves out something that would hold it back, so this is an upper bound. Throws base::InputError where
/// the track does not close or the hull's mesh cannot be read.
double highestStep(const vehicle::VehicleSpec& spec);

} // namespace grouser::events
