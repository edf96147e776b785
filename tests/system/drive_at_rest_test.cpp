// SPDX-License-Identifier: BSD-3-Clause
// A vehicle starts when the ground supports it, for any gravity and output interval.
#include "coupling/simulation.hpp"
#include "coupling/vehicle_rig.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/runs/shared_cache.hpp"

#include <gtest/gtest.h>

namespace grouser::coupling {
namespace {

/// Start time of the vehicle on rigid ground [s]; rows every `rowEvery` steps, 0: none.
double drivesOff(int rowEvery, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {"vehicle.sphere_radius=0.02", "driver.tension_ramp=0.03",
                                        "driver.weight_ramp=0.05", "driver.rest_time_limit=1.0"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  Simulation s(
      setup::simulationSetup(setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/rigid.toml", overrides)),
      base::cpuExec(1), [](double, double) {}, {}, nullptr, sharedSpheres());
  while (!s.vehicle()->driveStart()) {
    s.step();
    if (rowEvery > 0 && s.steps() % rowEvery == 0) s.restartMeans();
  }
  return *s.vehicle()->driveStart();
}

TEST(DriveAtRest, BeginsAtOneTimeWhateverTheRows) {
  const double start = drivesOff(0);
  EXPECT_GT(start, 0.08 + 0.05) << "after its ramps and 50 ms of rest";
  EXPECT_EQ(drivesOff(33), start);
}

TEST(DriveAtRest, BeginsUnderAnotherGravityToo) { EXPECT_LT(drivesOff(0, {"run.gravity=[0, 0, -3.7]"}), 1.0); }

} // namespace
} // namespace grouser::coupling
