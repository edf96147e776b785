// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/forecast/typical_times.hpp"

#include "runs/campaigns/forecast/machine_fit.hpp"

#include <algorithm>

namespace grouser::forecast {

TypicalTimes typicalTimes(const scene::Scene& scene, double grains, double spheres, const base::Exec& exec) {
  constexpr double kSetArea = 7;        // spheres of a light vehicle's sets times the square of their radius [m2]
  constexpr double kHull = 27e3;        // spheres of a hull, all that is cut for rigid ground
  constexpr double kDisk = 400e6;       // [bytes/s]
  constexpr double kVehicleFrame = 8e5; // [bytes]
  constexpr double kCheckpointed = 250; // of a grain [bytes]
  const bool cpu = exec.onCpu(), vehicle = scene.vehicle.has_value(), rigid = vehicle && grains == 0;
  const double cores = cpu ? std::max(1, exec.threads) : 1;
  if (vehicle && spheres == 0) {
    const double radius = scene.vehicle->sphereRadius.value_or(scene::Vehicle::kSphereRadius);
    spheres = rigid ? kHull : kSetArea / (radius * radius);
  }
  TypicalTimes t;
  t.grain = cpu ? 120e-9 / cores : 0.6e-9, t.list = cpu ? 1e-6 / cores : 6e-9;
  t.parts = cpu ? (rigid ? 60e-6 : 250e-6) : 150e-6;
  t.placing = vehicle ? 0.3 + (rigid ? 0 : 8e-6 * spheres) : 0.1, t.cutting = 300e-6 * spheres / cores,
  t.reading = 2e-6;
  t.output.begin = 0.02, t.output.picture = 0.5, t.output.plot = scene.output.plots ? 0.4 : 0;
  t.output.row = 1e-3 + (cpu ? 100e-9 : 10e-9) * grains;
  t.output.frameBytes = grains * frameBytesOfGrain(scene) + (vehicle ? kVehicleFrame : 0);
  t.output.frame = 1e-3 + t.output.frameBytes / kDisk;
  t.output.checkpointBytes = kCheckpointed * grains;
  t.output.checkpoint = 0.01 + t.output.checkpointBytes / kDisk;
  return t;
}

} // namespace grouser::forecast
