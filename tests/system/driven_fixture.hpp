// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/device_under_test.hpp"
#include "tests/runs/shared_cache.hpp"

#include <cmath>

namespace grouser::coupling {

/// A simulation at its start, on the device under test; its vehicle's parts are converted once for all tests.
inline Simulation begin(const scene::Scene& scene, int threads = 1) {
  return Simulation(
      setup::simulationSetup(scene), testExec(threads), [](double, double) {}, {}, nullptr, sharedSpheres());
}

/// Advances to the step nearest to `until` [s].
inline void advance(Simulation& simulation, double until) {
  const auto to = std::llround(until / simulation.timeStep());
  while (simulation.steps() < to) simulation.step();
}

} // namespace grouser::coupling
