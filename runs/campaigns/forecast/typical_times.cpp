// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/forecast/typical_times.hpp"

#include <algorithm>

namespace grouser::forecast {

TypicalTimes typicalTimes(double grains, double frameBytes, double spheres, double sphere, const base::Exec& exec) {
  constexpr double kSpheres = 7.5; // of a light vehicle's sets, over the square of their radius [m2]
  constexpr double kDisk = 200e6;  // [bytes/s]
  const double cores = exec.onCpu() ? std::max(1, exec.threads) : 1;
  if (spheres == 0 && sphere > 0) spheres = kSpheres / (sphere * sphere);
  TypicalTimes t;
  t.grain = exec.onCpu() ? 150e-9 / cores : 0.6e-9, t.list = exec.onCpu() ? 600e-9 / cores : 6e-9;
  t.vehicle = exec.onCpu() ? 500e-6 : 150e-6;
  t.placing = 0.3 + 30e-6 * spheres, t.cutting = 250e-6 * spheres / cores;
  t.reading = 2e-6;
  t.output = {.begin = 0.03, .row = 1e-3 + 50e-9 * grains, .frame = 1e-3 + grains * frameBytes / kDisk, .picture = 1};
  t.output.frameBytes = grains * frameBytes, t.output.checkpointBytes = 250 * grains;
  t.output.checkpoint = 0.01 + t.output.checkpointBytes / kDisk, t.output.plot = 1.5;
  return t;
}

} // namespace grouser::forecast
