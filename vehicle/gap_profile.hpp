// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/gear_surfaces.hpp"
#include "vehicle/spec.hpp"

namespace grouser::vehicle {

/// Returns the profile of the gaps between the teeth of the sprocket. `spec` must have shapes. Throws InputError if
/// there are too many teeth.
inline contact::GapProfile gapProfile(const VehicleSpec& spec) {
  const GearShapes& s = *spec.shapes;
  return {spec.sprocket.teeth, spec.sprocketPinRadius(), s.seatRadius, s.seatHalfAngle, s.flankRadius, s.tipRadius};
}

} // namespace grouser::vehicle
