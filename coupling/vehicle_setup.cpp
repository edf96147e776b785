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
  // Plane through the highest point, at the origin.
  return vehicle::placeOnSlope(spec, place.x, place.y, ground.height + ground.highest, clearance, place.heading,
                               ground.ahead, ground.left);
}

vehicle::Assembly assembleAt(const VehicleSetup& setup, const base::Pose& pose_W) {
  vehicle::AssemblyOptions options;
  options.fixChassis = setup.fixChassis;
  options.guide = setup.guide, options.right = !setup.single;
  options.drive = setup.driver.drive;
  options.pose_W = pose_W;
  return vehicle::assemble(setup.spec, options);
}

vehicle::Assembly assembleOnLevelGround(const VehicleSetup& setup) {
  const Placement& place = setup.place;
  return assembleAt(setup, vehicle::placeOnGround(setup.spec, place.x, place.y, 0, 0, place.heading));
}

} // namespace grouser::coupling
