// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/vehicle_setup.hpp"

#include "base/math.hpp"
#include "vehicle/ground_plane.hpp"

namespace grouser::coupling {

base::Pose setDown(const vehicle::VehicleSpec& spec, const Placement& place, double clearance,
                   const std::function<double(double, double)>& surfaceHeight) {
  const double c = base::cos(place.heading), s = base::sin(place.heading);
  const vehicle::GroundPlane ground = vehicle::groundPlane(spec, place.x, place.y, c, s, surfaceHeight);
  if (ground.ahead == 0 && ground.left == 0)
    return vehicle::placeOnGround(spec, place.x, place.y, ground.top + clearance, 0, place.heading);
  // The plane through the highest point, at the origin.
  return vehicle::placeOnSlope(spec, place.x, place.y, ground.height + ground.highest, clearance, place.heading,
                               ground.ahead, ground.left);
}

} // namespace grouser::coupling
