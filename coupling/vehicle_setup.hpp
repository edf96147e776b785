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
  double x{}, y{};  ///< midpoint between the sprocket axles [m]
  double heading{}; ///< from the x axis towards y [rad]
};

/// Pose of a vehicle placed on the ground: pitch and roll are those of the least-squares plane of the heights under
/// both tracks; the lowest grousers are `clearance` [m] above the highest point, normal to that plane.
base::Pose setDown(const vehicle::VehicleSpec& spec, const Placement& place, double clearance,
                   const std::function<double(double, double)>& surfaceHeight);

struct VehicleSetup;

/// Assembles the vehicle with its frame at `pose_W`.
vehicle::Assembly assembleAt(const VehicleSetup& setup, const base::Pose& pose_W);
/// Assembles the vehicle on level ground of height 0, with its lowest grousers on it.
vehicle::Assembly assembleOnLevelGround(const VehicleSetup& setup);

/// Stop conditions of a run; empty: none.
struct StopSetup {
  std::optional<double> distance; ///< [m] distance from the start
  std::optional<double> edge;     ///< [m] distance between a shoe and the edge of the terrain
  std::optional<double> immobile; ///< [s] driving time without motion
};

/// Vehicle of a scene, with its initial position and driver.
struct VehicleSetup {
  vehicle::VehicleSpec spec;
  Placement place;
  double clearance{}; ///< initial gap between the lowest grousers and the ground [m]
  bool onTerrain{};   ///< false: the vehicle hangs at height 0
  bool fixChassis{};  ///< true: immovable chassis, as on a test bench
  vehicle::HullGuide guide = vehicle::HullGuide::none;
  bool single = false;         ///< one track instead of two
  double sphereRadius{};       ///< radius of the parts' sphere sets [m]
  bool sphereRadiusGiven{};    ///< true: radius set in the scene; false: it may be refined
  double sphereRefinement{1};  ///< [-] divides all radii and the limits of automatic ones
  bool shapes{};               ///< gear contacts use spec.shapes, which must exist
  bool soilTouchesShoesOnly{}; ///< true: only shoes are in contact with soil
  bool hullTouches{};          ///< true: the hull is in contact with ground, grains and obstacles
  double hullSphereRadius{};   ///< radius of the hull's sphere set, with hullTouches [m]
  bool hullSphereRadiusGiven{};
  vehicle::DriverOptions driver;
  std::optional<vehicle::HitchOptions> hitch;
  StopSetup stop;
  double thickestStone{}; ///< maximum grain size between wheels and plates [m]: largest grain, if soil contacts them
  double largestTurn = std::numeric_limits<double>::infinity(); ///< maximum rotation of a body per step [rad]
};

} // namespace grouser::coupling
