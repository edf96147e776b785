// SPDX-License-Identifier: BSD-3-Clause
// Initial position of a vehicle, rejected steps, and a stop on created energy.
#include "base/error.hpp"
#include "base/math.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/placement.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "tests/runs/shared_cache.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::coupling {
namespace {

scene::Scene rigid(const std::vector<std::string>& overrides) {
  return setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/rigid.toml", overrides);
}

TEST(Placement, DefaultStandsOnTheTerrainAtEveryHeading) {
  for (const char* heading : {"0", "45", "90", "180", "270"}) {
    const scene::Scene scene = rigid({std::string("vehicle.heading=") + heading, "terrain.size=[5, 5]"});
    EXPECT_NO_THROW(setup::placeVehicle(scene, vehicle::readVehicleSpec(scene.vehicle->source()))) << heading;
  }
}

TEST(Placement, OutsideIsRefusedWithTheRoomItNeeds) {
  const scene::Scene scene = rigid({"vehicle.position=[7.0, 0]"});
  try {
    setup::placeVehicle(scene, vehicle::readVehicleSpec(scene.vehicle->source()));
    FAIL() << "the front would extend over the edge";
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("requires 3.4"), std::string::npos) << error.what();
  }
}

TEST(Placement, DrivingOffTheTerrainStopsTheRun) {
  const scene::Scene scene =
      rigid({"driver.sprocket_speed=20", "vehicle.position=[4.8, 0]", "vehicle.sphere_radius=0.02"});
  Simulation simulation(
      setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {}, {}, nullptr, sharedSpheres());
  EXPECT_THROW(while (simulation.time() < 1.0) simulation.step(), base::SimulationError);
}

const char* kBall = R"(version = 1
[run]
duration = 1.0
time_step = 1e-4
[material.soil]
stiffness = 1e6
restitution = 1
[material.hard]
stiffness = 1e6
restitution = 1
[[grain]]
position = [0, 0, 0.1]
radius = 0.027
material = "soil"
[[plane]]
point = [0, 0, 0]
material = "hard"
)";

TEST(TimeStep, TheStiffestLawOfTheSceneSetsTheLimit) {
  const double soft = setup::stepLimit(setup::parseScene(kBall, "ball.toml")).step;
  std::string stiff = kBall;
  stiff += "[contact.\"soil|hard\"]\nstiffness = 1e9\n";
  // A single grain and a plane: half of the limit of an impact, 4 k / m.
  EXPECT_NEAR(soft / setup::stepLimit(setup::parseScene(stiff, "ball.toml")).step, std::sqrt(1e9 / 1e6), 1e-3);
  EXPECT_THROW(setup::chooseTimeStep(setup::parseScene(stiff, "ball.toml")), base::InputError);
}

TEST(TimeStep, DampingCountsForTheModeNotForOneContact) {
  // Restitution 0.1, clamped: zeta 1.24318785 of a pair. Each of a grain's contacts has c = zeta sqrt(2 k m); the
  // mode of 8 k / m has 8 c / m: dt = 4 / (C + sqrt(C^2 + 4 K)).
  scene::Scene s = setup::parseScene(kBall, "ball.toml", {"material.soil.restitution=0.1", "material.soil.friction=0"});
  s.planes.clear();
  const double mass = 2500 * 4.0 / 3 * base::kPi * 0.027 * 0.027 * 0.027, k = 1e6;
  const double damping = 8 * 1.24318785 * std::sqrt(2 * k * mass) / mass, stiffness = 8 * k / mass;
  const double limit = 4 / (damping + std::sqrt(damping * damping + 4 * stiffness));
  EXPECT_NEAR(setup::stepLimit(s).calm / limit, 1, 1e-6);
}

} // namespace
} // namespace grouser::coupling
