// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/step_bound.hpp"

/// Geometric limits of a vehicle, for the sizes of obstacles and as references for runs.
namespace grouser::events {

/// Dimensions and masses of a vehicle in its design position on level ground.
struct VehicleShape {
  double rear = 0, front = 0;           ///< distance from the sprocket axle to the rear and front ends [m]
  double diagonal = 0;                  ///< longest distance between two points of the track outline [m]
  double halfWidth = 0;                 ///< distance from the middle to the outer edge of the pads [m]
  double firstWheel = 0, lastWheel = 0; ///< x of the axles of the rearmost and the foremost road wheel [m]
  SidePoint massCentre;                 ///< centre of mass of the vehicle; z above level ground
  double tread = 0;                     ///< distance between the track centre lines [m]
  double padWidth = 0;                  ///< [m]
  double pitchRadius = 0;               ///< [m]
  SidePoint controlled;                 ///< point of the hull that a course controls (vehicle::HullMotion)
  double mass = 0;                      ///< [kg]
  double gravity = kGravity;            ///< [m/s2]
  double friction = 0;                  ///< shoe friction on rigid ground [-]
  double highestStep = 0;               ///< upper bound of climbable steps (highestStep() of the spec) [m]

  double length() const { return rear + front; }
  double groundRun() const { return lastWheel - firstWheel; }
  double weight() const { return mass * gravity; } ///< [N]
};

/// `gravity` [m/s2] > 0. Throws base::InputError if the track does not close or the hull mesh cannot be read.
VehicleShape shapeOf(const vehicle::VehicleSpec& spec, double gravity);

/// Widths of a gap between two slabs [m].
struct GapBounds {
  double sure = 0;  ///< widest gap with a supported road wheel on each side of the centre of mass at all times
  double level = 0; ///< in wider gaps, a level track is supported on one side only as the centre of mass crosses the
                    ///< edge: the nose drops against the far wall, and friction decides
  double never = 0; ///< track length: in wider gaps, the track reaches one side only at any pitch
};
GapBounds gapBounds(const VehicleShape& shape);

/// Tangent of the side slope on which the vehicle tips over the outer edge of its lower track [-]: half width over
/// height of the centre of mass. Neglects suspension travel.
double tippingSlope(const VehicleShape& shape);

/// mu W L / 4: turning resistance moment of a pivot turn [N m] for uniform pressure and much smaller longitudinal than
/// lateral slip.
double turningMoment(const VehicleShape& shape, double friction, double weight);

} // namespace grouser::events
