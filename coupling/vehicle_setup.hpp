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

/// Where a vehicle is set down.
struct Placement {
  double x{}, y{};  ///< of the middle between the sprockets [m]
  double heading{}; ///< from the x axis towards y [rad]
};

/// Where a vehicle stands when it is set down along the ground under it: pitch and roll are those of the least-squares
/// plane of the heights under both tracks, and the lowest grousers stand `clearance` [m] above the highest point,
/// square to that plane.
base::Pose setDown(const vehicle::VehicleSpec& spec, const Placement& place, double clearance,
                   const std::function<double(double, double)>& surfaceHeight);

struct VehicleSetup;

/// The vehicle as it is assembled with the vehicle frame at `pose_W`.
vehicle::Assembly assembleAt(const VehicleSetup& setup, const base::Pose& pose_W);
/// Assembles the vehicle on level ground of height 0, which the lowest grousers touch.
vehicle::Assembly assembleOnLevelGround(const VehicleSetup& setup);

/// What ends a run before its time; empty where it is not asked.
struct StopSetup {
  std::optional<double> distance; ///< [m] from where it was set down
  std::optional<double> edge;     ///< [m] between a shoe and the end of the terrain
  std::optional<double> immobile; ///< [s] that it is driven and does not move
};

/// A vehicle, where it is set down, and its driver.
struct VehicleSetup {
  vehicle::VehicleSpec spec;
  Placement place;
  double clearance{}; ///< between the lowest grouser and the ground at the start [m]
  bool onTerrain{};   ///< else it hangs at height 0
  bool fixChassis{};  ///< as on a bench
  vehicle::HullGuide guide = vehicle::HullGuide::none;
  bool single = false;         ///< track, of two
  double sphereRadius{};       ///< of the parts' sphere sets [m]
  bool sphereRadiusGiven{};    ///< by the scene; else it may become finer
  double sphereRefinement{1};  ///< [-] divides all radii and what automatic ones permit
  bool shapes{};               ///< gear contacts use spec.shapes, which must exist
  bool soilTouchesShoesOnly{}; ///< and no other part
  bool hullTouches{};          ///< ground, grains and obstacles
  double hullSphereRadius{};   ///< of its set then [m]
  bool hullSphereRadiusGiven{};
  vehicle::DriverOptions driver;
  std::optional<vehicle::HitchOptions> hitch;
  StopSetup stop;
  double thickestStone{}; ///< that may get between wheels and plates [m]: the largest grain, where soil meets them
  double largestTurn = std::numeric_limits<double>::infinity(); ///< of a body in a step [rad]
};

} // namespace grouser::coupling
