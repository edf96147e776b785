// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "runs/setup/placement.hpp"
#include "vehicle/assembly.hpp"
#include "vehicle/driver.hpp"
#include "vehicle/hitch.hpp"
#include "vehicle/spec.hpp"

#include <limits>
#include <optional>
#include <string>

namespace grouser::setup {

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
  bool single = false;        ///< track, of two
  double sphereRadius{};      ///< of the parts' sphere sets [m]
  bool sphereRadiusGiven{};   ///< by the scene; else it may become finer
  double sphereRefinement{1}; ///< [-] divides all radii and what automatic ones permit
  bool soilMeetsShoesAlone{}; ///< and no other part
  bool hullTouches{};         ///< ground, grains and obstacles
  double hullSphereRadius{};  ///< of its set then [m]
  bool hullSphereRadiusGiven{};
  vehicle::DriverOptions driver;
  std::optional<vehicle::HitchOptions> hitch;
  StopSetup stop;
  double thickestStone{}; ///< that may get between wheels and plates [m]: the largest grain, where soil meets them
  double largestTurn = std::numeric_limits<double>::infinity(); ///< of a body in a step [rad]
};

/// Of a hitch's rope or bar [N/m]: as given, or such that hull (and sled) would swing on it at 10 Hz. 0 without either.
double hitchStiffness(const scene::Hitch& hitch, const vehicle::VehicleSpec& spec);
/// What swings on it [kg]: the hull, or hull and sled against each other.
double hitchedMass(const scene::Hitch& hitch, const vehicle::VehicleSpec& spec);

/// Reads the spec. Throws InputError where that, or where the vehicle stands, is not possible.
VehicleSetup vehicleSetup(const scene::Scene& scene);

/// Takes the vehicle out of the scene, with all that only a vehicle has: driver, hitch, stop, its columns of the
/// output.
void removeVehicle(scene::Scene& scene);

} // namespace grouser::setup
