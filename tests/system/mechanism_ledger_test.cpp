// SPDX-License-Identifier: BSD-3-Clause
// The ledger of mechanisms and of a vehicle's bodies in a run.
#include "coupling/mechanism.hpp"
#include "coupling/simulation.hpp"
#include "coupling/vehicle_rig.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/runs/shared_cache.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace grouser::coupling {
namespace {

/// Rounding of 1e4 or more steps is some 1e-14 of the turnover.
constexpr double kRounding = 1e-9;

SimulationSetup setupOf(const std::string& scene, const std::vector<std::string>& overrides = {}) {
  return setup::simulationSetup(setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/" + scene, overrides));
}

TEST(MechanismLedger, ClosesToRoundingAndItsIntegrationErrorFallsWithTheOrder) {
  struct Case {
    const char *name, *integrator;
    double step, duration, order;
  };
  for (const Case& c : {Case{"slider_crank", "rattle", 1e-4, 0.1, 2}, Case{"andrews", "rattle", 1e-4, 0.02, 2},
                        Case{"andrews", "symplectic_euler", 1e-5, 0.02, 1}, Case{"pendulum", "rattle", 1e-2, 2, 2},
                        Case{"pendulum", "symplectic_euler", 1e-3, 2, 1}, Case{"fourbar2", "rattle", 1e-3, 1, 2}}) {
    double error[2];
    for (int half = 0; half < 2; ++half) {
      const double step = half ? c.step / 2 : c.step;
      const SimulationSetup setup = setupOf(std::string("runs/mechanisms/") + c.name + ".toml",
                                            {std::string("run.integrator=\"") + c.integrator + '"'});
      Mechanism mechanism(*setup.mechanism, step);
      const multibody::Totals start = mechanism.bodiesBalance().now;
      error[half] = 0;
      for (long i = 0; i < std::lround(c.duration / step); ++i) {
        mechanism.advance();
        error[half] = std::max(error[half], std::fabs(mechanism.bodiesBalance().integrationError));
      }
      const multibody::Balance l = mechanism.bodiesBalance();
      EXPECT_GT(l.turnover, 0);
      EXPECT_LE(std::fabs(l.leftOver), kRounding * l.turnover) << c.name;
      EXPECT_NEAR((l.now.kinetic - start.kinetic) + (l.now.gravity - start.gravity) + (l.now.elastic - start.elastic) +
                      l.dissipated() + l.integrationError,
                  l.driveWork, kRounding * l.turnover)
          << c.name;
    }
    std::printf("%-14s %-17s integration error %.2e J, order %.2f\n", c.name, c.integrator, error[1],
                std::log2(error[0] / error[1]));
    EXPECT_NEAR(std::log2(error[0] / error[1]), c.order, 0.15) << c.name << ", " << c.integrator;
  }
}

TEST(MechanismLedger, GoesOnFromACheckpointWithTheSameBitsAndIsNotHashed) {
  const SimulationSetup setup = setupOf("runs/mechanisms/slider_crank.toml");
  Mechanism straight(*setup.mechanism, 1e-3), resumed(*setup.mechanism, 1e-3);
  for (int i = 0; i < 50; ++i) straight.advance();
  MechanismState saved = straight.save();
  resumed.restore(saved);
  for (int i = 0; i < 50; ++i) straight.advance(), resumed.advance();
  const multibody::Balance a = straight.bodiesBalance(), b = resumed.bodiesBalance();
  EXPECT_NE(a.integrationError, 0);
  EXPECT_EQ(a.integrationError, b.integrationError);
  EXPECT_EQ(a.leftOver, b.leftOver);
  EXPECT_EQ(a.turnover, b.turnover);
  EXPECT_EQ(a.linearRemainder, b.linearRemainder);
  EXPECT_EQ(a.angularRemainder, b.angularRemainder);
  EXPECT_EQ(straight.save().bodies, resumed.save().bodies);

  const std::vector<std::uint32_t> words = saved.words();
  for (std::size_t i = saved.bodies.size() - multibody::State::kBooks; i < saved.bodies.size(); ++i)
    saved.bodies[i] += 1;
  EXPECT_EQ(saved.words(), words);
  saved.bodies[saved.bodies.size() - multibody::State::kBooks - 1] += 1;
  EXPECT_NE(saved.words(), words);
}

TEST(MechanismLedger, OfAVehiclesBodiesClosesToRounding) {
  Simulation simulation(
      setupOf("tests/scenes/rigid.toml", {"vehicle.sphere_radius=0.02"}), base::cpuExec(1), [](double, double) {}, {},
      nullptr, sharedSpheres());
  while (simulation.time() < 0.03) simulation.step();
  const multibody::Balance l = simulation.vehicle()->bodiesBalance();
  EXPECT_GT(l.turnover, 0.5);
  EXPECT_NE(l.externalWork, 0) << "it stands on the ground";
  EXPECT_NE(l.elasticGain, 0);
  EXPECT_GT(l.springDamping, 0);
  EXPECT_LE(std::fabs(l.leftOver), kRounding * l.turnover);
  EXPECT_EQ(l.kineticGain, l.now.kinetic) << "it starts at rest";
  EXPECT_NEAR(l.kineticGain + l.potentialGain + l.elasticGain + l.dissipated() + l.integrationError,
              l.driveWork + l.externalWork, kRounding * l.turnover);
  EXPECT_LE(norm(l.linearRemainder), 1e-9) << "impulses are some 1e4 N s";
  EXPECT_LE(norm(l.angularRemainder), 1e-8);
}

} // namespace
} // namespace grouser::coupling
