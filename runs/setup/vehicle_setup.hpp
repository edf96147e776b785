// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "runs/setup/placement.hpp"
#include "vehicle/driver.hpp"
#include "vehicle/spec.hpp"

#include <limits>
#include <string>

namespace grouser::setup {

/// A vehicle, where it is set down, and its driver.
struct VehicleSetup {
  vehicle::VehicleSpec spec;
  Placement place;
  double clearance{};         ///< between the lowest grouser and the ground at the start [m]
  bool onTerrain{};           ///< else it hangs at height 0
  bool fixChassis{};          ///< as on a bench
  double sphereRadius{};      ///< of the parts' sphere sets [m]
  bool soilMeetsShoesAlone{}; ///< and no other part
  bool hullTouches{};         ///< ground, grains and obstacles
  vehicle::DriverOptions driver;
  double thickestStone{}; ///< that may get between wheels and plates [m]: the largest grain, where soil meets them
  double largestTurn = std::numeric_limits<double>::infinity(); ///< of a body in a step [rad]
};

/// Reads the spec. Throws InputError where that, or where the vehicle stands, is not possible.
VehicleSetup vehicleSetup(const scene::Scene& scene);

} // namespace grouser::setup
