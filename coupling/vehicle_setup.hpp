// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/assembly.hpp"
#include "vehicle/driver.hpp"
#include "vehicle/hitch.hpp"
#include "vehicle/spec.hpp"

#include <functional>
#include <limits>
#include <optional>

namespace grouser::coupling {

/// Initial position of a vehicle.
struct Placement {
  double x{}, y{};  ///< of the middle between the sprockets [m]
  double heading{}; ///< from the x axis towards y [rad]
};

/// Pose of a vehicle placed on the ground: pitch and roll are those of the least-squares plane of the heights under
/// both tracks, and the lowest grousers are `clearance` [m] above the highest point, normal to that plane.
base::Pose setDown(const vehicle::VehicleSpec& spec, const Placement& place, double clearance,
                   const std::function<double(double, double)>& surfaceHeight);

struct VehicleSetup;

/// The vehicle assembled with its frame at `pose_W`.
vehicle::Assembly assembleAt(const VehicleSetup& setup, const base::Pose& pose_W);
/// Assembles the vehicle on level ground of height 0, which the lowest grousers touch.
vehicle::Assembly assembleOnLevelGround(const VehicleSetup& setup);

/// Conditions that end a run early; empty: none.
struct StopSetup {
  std::optional<double> distance; ///< [m] from the start
  std::optional<double> edge;     ///< [m] between a shoe and the edge of the terrain
  std::optional<double> immobile; ///< [s] of drive without motion
};

/// A vehicle, its initial position, and its driver.
struct VehicleSetup {
  vehicle::VehicleSpec spec;
  Placement place;
  double clearance{}; ///< between the lowest grouser and the ground at the start [m]
  bool onTerrain{};   ///< else it hangs at height 0
  bool fixChassis{};  ///< as on a bench
  vehicle::HullGuide guide = vehicle::HullGuide::none;
  bool single = false;         ///< one track instead of two
  double sphereRadius{};       ///< of the parts' sphere sets [m]
  bool sphereRadiusGiven{};    ///< set in the scene; else it may become finer
  double sphereRefinement{1};  ///< [-] divides all radii and the limits of automatic ones
  bool shapes{};               ///< gear contacts use spec.shapes, which must exist
  bool soilTouchesShoesOnly{}; ///< and no other part
  bool hullTouches{};          ///< ground, grains and obstacles
  double hullSphereRadius{};   ///< of its set then [m]
  bool hullSphereRadiusGiven{};
  vehicle::DriverOptions driver;
  std::optional<vehicle::HitchOptions> hitch;
  StopSetup stop;
  double thickestStone{}; ///< thickest grain between wheels and plates [m]: the largest one, if soil touches them
  double largestTurn = std::numeric_limits<double>::infinity(); ///< of a body in a step [rad]
};

} // namespace grouser::coupling
