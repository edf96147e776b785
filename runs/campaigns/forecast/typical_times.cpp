// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/forecast/typical_times.hpp"

#include "base/cpu_threads.hpp"
#include "base/math.hpp"
#include "runs/campaigns/forecast/machine_fit.hpp"
#include "runs/setup/bed_options.hpp"
#include "vehicle/spec_file.hpp"

#include <algorithm>

namespace grouser::forecast {

int usefulThreads(const base::Exec& exec) {
  return exec.onCpu() ? std::max(1, std::min(exec.threads, base::lowestLimit(base::threadLimits()).cores)) : 1;
}

double pairsBelowTracks(const scene::Scene& scene) {
  if (!scene.vehicle || !scene.terrain || !scene.terrain->granular()) return 0;
  const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(scene.vehicle->source());
  const double tracks = scene.vehicle->tracks == scene::Tracks::single ? 1 : 2;
  const double length = std::max(spec.groundRun(), 2 * spec.shoe.halfLength);
  const double radius = setup::bedOptions(scene).meanRadius();
  return tracks * length * 2 * spec.shoe.padHalfWidth / (base::kPi * radius * radius);
}

TypicalTimes typicalTimes(const scene::Scene& scene, double grains, double spheres, const base::Exec& exec) {
  constexpr double kSetArea = 7;        // number of spheres in the sets of a light vehicle x radius squared [m2]
  constexpr double kHull = 27e3;        // number of spheres of a hull, the only set on rigid ground
  constexpr double kDisk = 400e6;       // [bytes/s]
  constexpr double kVehicleFrame = 8e5; // [bytes]
  constexpr double kCheckpointed = 250; // checkpoint size per grain [bytes]
  constexpr double kPair = 170e-9;      // CPU time per grain-part pair and step [s]
  const bool cpu = exec.onCpu(), vehicle = scene.vehicle.has_value(), rigid = vehicle && grains == 0;
  const double cores = cpu ? usefulThreads(exec) : 1;
  if (vehicle && spheres == 0) {
    const double radius = scene.vehicle->sphereRadius.value_or(scene::Vehicle::kSphereRadius);
    spheres = rigid ? kHull : kSetArea / (radius * radius);
  }
  TypicalTimes t;
  t.grain = cpu ? 120e-9 / cores : 0.6e-9, t.list = cpu ? 1e-6 / cores : 6e-9;
  t.parts = cpu ? (rigid ? 60e-6 : 250e-6 + kPair * pairsBelowTracks(scene) / cores) : 150e-6;
  t.placing = vehicle ? 0.3 + (rigid ? 0 : 8e-6 * spheres) : 0.1, t.cutting = 300e-6 * spheres / cores,
  t.reading = 2e-6;
  t.output.begin = 0.02, t.output.picture = 0.5, t.output.plot = scene.output.plots ? 0.4 : 0;
  t.output.row = 1e-3 + (cpu ? 100e-9 : 10e-9) * grains;
  t.output.frameBytes = grains * frameBytesOfGrain(scene) + frameBytesOfFields(scene) + (vehicle ? kVehicleFrame : 0);
  t.output.frame = 1e-3 + t.output.frameBytes / kDisk;
  t.output.checkpointBytes = kCheckpointed * grains;
  t.output.checkpoint = 0.01 + t.output.checkpointBytes / kDisk;
  return t;
}

SettledTile typicalTile(const TypicalTimes& times, double timeStep) {
  constexpr double kGrains = 300, kRest = 0.7, kList = 0.005; // grains; time until rest, list lifetime [s]
  SettledTile tile;
  tile.grains = kGrains, tile.steps = kRest / timeStep, tile.rebuilds = kRest / kList;
  tile.falling = tile.resting = kGrains * times.grain, tile.list = kGrains * times.list;
  tile.seconds = tile.steps * tile.falling + tile.rebuilds * tile.list;
  tile.complete = false;
  return tile;
}

} // namespace grouser::forecast
