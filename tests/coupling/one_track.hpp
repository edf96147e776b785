// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation_setup.hpp"
#include "coupling/sphere_sets.hpp"
#include "vehicle/spec_file.hpp"

#include <map>
#include <string>
#include <utility>

namespace grouser::coupling {

/// One track of the light vehicle, guided by rails, with short ramps; without ground.
inline SimulationSetup oneTrack(double timeStep) {
  SimulationSetup setup;
  setup.timeStep = timeStep, setup.gravity = {0, 0, -9.81};
  setup.vehicle.emplace();
  setup.vehicle->spec = vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml");
  setup.vehicle->clearance = 0.001, setup.vehicle->onTerrain = true;
  setup.vehicle->single = true, setup.vehicle->guide = vehicle::HullGuide::pitching;
  setup.vehicle->sphereRadius = 0.02, setup.vehicle->sphereRadiusGiven = true;
  setup.vehicle->driver.tensionRamp = 0.05, setup.vehicle->driver.weightRamp = 0.1;
  return setup;
}

/// Converts each mesh of a vehicle to spheres once for all tests.
class CutOnce : public SphereSets {
public:
  base::SphereSet cut(const PartCut& part, spheredecomp::Protrusion* protrusion) override {
    const auto [at, fresh] = cuts_.try_emplace(part.name);
    if (fresh) at->second.first = cutPart(part, at->second.second);
    if (protrusion) *protrusion = at->second.second;
    return at->second.first;
  }

private:
  std::map<std::string, std::pair<base::SphereSet, spheredecomp::Protrusion>> cuts_;
};

inline SphereSets* cutOnce() {
  static CutOnce kept;
  return &kept;
}

} // namespace grouser::coupling
