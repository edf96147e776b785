// SPDX-License-Identifier: BSD-3-Clause
// A vehicle that rests, drives, turns, or is dropped on a small bed raises no alarm at any output interval.
#include "base/error.hpp"
#include "base/math.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/runs/shared_cache.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

namespace grouser::coupling {
namespace {

struct Drive {
  const char* name;
  const char* base; ///< a scene of tests/scenes
  std::vector<std::string> sets;
  std::int64_t steps;
};
std::ostream& operator<<(std::ostream& out, const Drive& d) { return out << d.name; }

class SoundVehicles : public ::testing::TestWithParam<Drive> {
protected:
  /// The claim of docs/steps.md#energy-ledger for them.
  static void TearDownTestSuite() {
    std::cout << fmt::format("sound vehicles: of what was dissipated the steps have made up to {:.1f} % between two "
                             "looks, beyond what never alarms, and up to {:.1f} % since the start\n",
                             100 * sinceLook, 100 * sinceStart);
  }
  static void note(const EnergyGuard& watch, const Ledger& now) {
    if (now.dissipated.parts <= now.dissipated.ofGrains()) return; // heat is not checked
    const EnergyGuard::Exchange x = watch.since(now, std::fabs(now.kinetic) + std::fabs(now.elastic));
    if (x.taken > 0 && -x.lost > x.neverAlarms) sinceLook = std::max(sinceLook, (-x.lost - x.neverAlarms) / x.taken);
    sinceStart = std::max(sinceStart, -now.integrationError / now.dissipated.total());
  }
  inline static double sinceLook = 0, sinceStart = 0;

  /// Result of a drive with rows every `row` steps: its hash, or its error.
  static std::string driven(double step, std::int64_t row) {
    std::vector<std::string> sets = GetParam().sets;
    sets.push_back(fmt::format("run.time_step={:g}", step));
    try {
      const scene::Scene scene =
          setup::loadScene(fmt::format("{}/tests/scenes/{}.toml", GROUSER_SOURCE_DIR, GetParam().base), sets);
      Simulation simulation(
          setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {}, {}, sharedBeds(), sharedSpheres());
      EnergyGuard watch;
      while (simulation.steps() < GetParam().steps) {
        simulation.step();
        if (simulation.steps() % EnergyGuard::kInterval == 0)
          note(watch, simulation.ledger()), watch.look(simulation.ledger());
        if (simulation.steps() % row != 0) continue;
        simulation.ledger(), simulation.vehicle()->observe(), simulation.restartMeans();
      }
      simulation.checkEnergy();
      return simulation.stateHash();
    } catch (const std::exception& error) {
      return error.what();
    }
  }
};

TEST_P(SoundVehicles, RaiseNoAlarmAndHaveOneAnswer) {
  const std::string first = driven(1e-4, 11);
  EXPECT_EQ(first.size(), 16u) << first;
  EXPECT_EQ(driven(1e-4, 512), first);
  EXPECT_EQ(driven(1e-4, 1'000'000), first);
}

INSTANTIATE_TEST_SUITE_P(Drives, SoundVehicles,
                         ::testing::Values(Drive{"Straight",
                                                 "rigid",
                                                 {"driver.sprocket_speed=10", "driver.tension_ramp=0.02",
                                                  "driver.weight_ramp=0.03", "driver.drive_start=0.05",
                                                  "driver.drive_ramp=0.05", "vehicle.sphere_radius=0.03"},
                                                 1600},
                                           Drive{"OnABed", "coupled", {}, 600},
                                           Drive{"OnGrainsThatBounce",
                                                 "coupled",
                                                 {"material.soil.restitution=0.95", "material.soil.stiffness=1e7",
                                                  "terrain.settle_kinetic_energy=0.5", "vehicle.sphere_radius=0.03",
                                                  "driver.tension_ramp=0.02", "driver.weight_ramp=0.03",
                                                  "driver.drive_start=0.05", "driver.drive_ramp=0.02"},
                                                 600}),
                         [](const auto& tested) { return std::string(tested.param.name); });

// Unresolved springs are rejected before rotations get so large: this case uses a lower limit.
TEST(JudgedVehicle, PartsThatTurnTooFarAStepEndTheRun) {
  const scene::Scene scene =
      setup::loadScene(GROUSER_SOURCE_DIR "/tests/scenes/rigid.toml",
                       {"run.time_step=1e-4", "driver.tension_ramp=0", "driver.weight_ramp=0", "driver.drive_start=0",
                        "driver.drive_ramp=0", "vehicle.sphere_radius=0.03"});
  SimulationSetup setup = setup::simulationSetup(scene);
  EXPECT_NEAR(setup.vehicle->largestTurn, 2 * base::kPi / 20, 1e-15);
  setup.vehicle->largestTurn = 2 * base::kPi / 1e5;
  Simulation simulation(
      setup, base::cpuExec(1), [](double, double) {}, {}, sharedBeds(), sharedSpheres());
  try {
    while (simulation.steps() < 100) simulation.step();
    FAIL() << "no error";
  } catch (const base::SimulationError& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("step 50,"), std::string::npos) << said;
    EXPECT_NE(said.find("rotates by"), std::string::npos) << said;
    EXPECT_NE(said.find("more than 6.283e-05 rad (run.steps_per_period = 100000 steps a turn)"), std::string::npos)
        << said;
  }
}

} // namespace
} // namespace grouser::coupling
