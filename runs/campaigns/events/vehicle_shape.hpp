// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/step_bound.hpp"

/// What a vehicle can pass by its shape alone: for the sizes of obstacles, and to compare with what runs have shown.
namespace grouser::events {

/// Lengths and masses of a vehicle as drawn, on level ground.
struct VehicleShape {
  double rear = 0, front = 0;           ///< how far it reaches behind and before the sprockets' axle [m]
  double diagonal = 0;                  ///< longest way between two points of a track's outline [m]
  double halfWidth = 0;                 ///< to the outer edge of the pads [m]
  double firstWheel = 0, lastWheel = 0; ///< x of the axles of the rearmost and the foremost road wheel [m]
  SidePoint massCentre;                 ///< of the whole vehicle
  double tread = 0;                     ///< distance of the middles of both tracks [m]
  double padWidth = 0;                  ///< [m]
  double pitchRadius = 0;               ///< [m]
  double mass = 0;                      ///< [kg]
  double friction = 0;                  ///< of shoes on rigid ground [-]
  double highestStep = 0;               ///< above which it climbs none (highestStep() of its spec) [m]

  double length() const { return rear + front; }
  double groundRun() const { return lastWheel - firstWheel; }
};

/// Throws base::InputError where its track does not close or its hull's mesh cannot be read.
VehicleShape shapeOf(const vehicle::VehicleSpec& spec);

/// Widths of a gap between two slabs [m].
struct GapBounds {
  double sure = 0;  ///< crossed level: some road wheel stands on each side of the centre of mass all the time
  double level = 0; ///< from here on the centre of mass hangs free while the track, held level, reaches one side only:
                    ///< the nose falls against the far wall, and grip decides
  double never = 0; ///< the track's length: it lies on one side alone however it is pitched
};
GapBounds gapBounds(const VehicleShape& shape);

/// Tangent of the side slope on which the vehicle tips over the outer edge of its lower track: half width over the
/// height of the centre of mass, suspension as drawn [-].
double tippingSlope(const VehicleShape& shape);

/// mu W L / 4: moment that resists a turn on the spot, where the ground run carries evenly and the track's own slip is
/// small against that sideways [N m].
double turningMoment(const VehicleShape& shape, double friction, double weight);

} // namespace grouser::events
