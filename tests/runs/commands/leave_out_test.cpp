// SPDX-License-Identifier: BSD-3-Clause
// Absent features of a scene are not allocated, built or run; `grouser plan` lists them in advance.
#include "coupling/simulation.hpp"
#include "runs/commands/plan.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/runs/shared_cache.hpp"

#include <gtest/gtest.h>

namespace grouser::coupling {
namespace {

/// A layer of grains on a rough floor, and a distant plane.
scene::Scene bed(const std::vector<std::string>& overrides = {}) {
  return setup::parseScene("version = 1\n[run]\nduration = 0.1\ntime_step = 1e-4\n[material.soil]\nstiffness = 1e5\n"
                           "friction = 0.5\n[terrain]\nheightmap = \"heightmaps/hills.png\"\nsize = [0.6, 0.6]\n"
                           "height_range = [0, 0.03]\nmaterial = \"soil\"\ngrain_radius = 0.03\nlayers = "
                           "2\narrangement = \"lattice\"\nfloor_grains = false\nwall_friction = 0.5\n"
                           "settle_time_limit = 0.0\n",
                           "bed.toml", overrides);
}

scene::Scene pendulum() {
  return setup::parseScene(
      "version = 1\n[run]\nduration = 1\ntime_step = 1e-3\n[[body]]\nname = \"bob\"\nmass = 1\n"
      "inertia = [1, 1, 1]\nposition = [1, 0, 0]\n[[joint]]\nname = \"pin\"\ntype = \"revolute\"\nbodies = [\"world\", "
      "\"bob\"]\npoint = [0, 0, 0]\naxis = [0, 1, 0]\n",
      "pendulum.toml");
}

scene::Scene rigid() {
  return setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/rigid.toml", {"vehicle.sphere_radius=0.04"});
}

std::unique_ptr<Simulation> made(const scene::Scene& scene, int steps = 3) {
  auto s = std::make_unique<Simulation>(
      setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {}, base::Comm{}, nullptr, sharedSpheres());
  while (s->steps() < steps) s->step();
  return s;
}

/// The line of the plan that contains `what`.
std::string planLine(const scene::Scene& scene, const std::string& what) {
  const std::string text = commands::planText(scene);
  const std::size_t at = text.find(what);
  if (at == std::string::npos) return "";
  const std::size_t begin = text.rfind('\n', at) + 1;
  return text.substr(begin, text.find('\n', at) - begin);
}

bool isOn(const scene::Scene& scene, const std::string& what) { return !planLine(scene, "on   " + what).empty(); }
bool isOff(const scene::Scene& scene, const std::string& what) { return !planLine(scene, "off  " + what).empty(); }

TEST(LeaveOut, FrictionlessSceneHasNoHistory) {
  const scene::Scene rough = bed(), smooth = bed({"material.soil.friction=0", "terrain.wall_friction=0"});
  const auto with = made(rough), without = made(smooth);
  const terrain::Grains &a = *with->ground().grains, &b = *without->ground().grains;
  EXPECT_FALSE(a.system().neighbours.toHost().history.empty());
  EXPECT_TRUE(b.system().neighbours.toHost().history.empty());
  EXPECT_TRUE(b.state().contactShear.empty());
  EXPECT_TRUE(b.state().wallShear.empty());
  // Three floats for each slot of the list, and for each wall.
  const std::size_t places = a.system().neighbours.toHost().slot.size();
  EXPECT_GE(a.system().deviceBytes(), b.system().deviceBytes() + 12 * places);
  EXPECT_TRUE(isOn(rough, "friction history"));
  EXPECT_TRUE(isOff(smooth, "friction history"));
}

TEST(LeaveOut, SceneWithoutRollingResistanceHasNoRollingHistory) {
  const auto simulation = made(bed());
  EXPECT_TRUE(simulation->ground().grains->state().contactRolling.empty());
  EXPECT_TRUE(simulation->ground().grains->state().wallRolling.empty());
}

TEST(LeaveOut, SceneOfOneRadiusHasNoRadii) {
  const auto simulation = made(bed());
  const terrain::GrainState state = simulation->ground().grains->state();
  EXPECT_FALSE(simulation->ground().grains->system().constants.manyRadii());
  EXPECT_TRUE(state.radius.empty());
  EXPECT_TRUE(state.material.empty());
}

TEST(LeaveOut, SceneWithOnlyBodiesHasNoGrains) {
  const auto simulation = made(pendulum());
  EXPECT_EQ(simulation->ground().grains, nullptr);
  EXPECT_EQ(simulation->vehicle(), nullptr);
  EXPECT_FALSE(simulation->ground().surface);
  EXPECT_TRUE(isOff(pendulum(), "grains"));
  EXPECT_TRUE(isOff(pendulum(), "vehicle"));
}

TEST(LeaveOut, RigidGroundHasNoGrains) {
  const auto simulation = made(rigid());
  EXPECT_EQ(simulation->ground().grains, nullptr);
  EXPECT_EQ(simulation->ground().undisturbed, nullptr);
  EXPECT_TRUE(isOff(rigid(), "grains"));
  EXPECT_TRUE(isOn(rigid(), "rigid ground"));
}

TEST(LeaveOut, SceneWithoutVehicleHasNone) {
  const auto simulation = made(bed());
  EXPECT_EQ(simulation->vehicle(), nullptr);
  EXPECT_EQ(simulation->mechanism(), nullptr);
  EXPECT_NE(planLine(bed(), "off  vehicle").find("no mesh is read"), std::string::npos);
}

TEST(LeaveOut, OneRankHasNoSubdomainAndNoGhosts) {
  const auto simulation = made(bed());
  EXPECT_EQ(simulation->ground().grains->distribution(), nullptr);
  EXPECT_EQ(simulation->ground().grains->view().ghost, nullptr);
  EXPECT_EQ(simulation->ground().grains->view().count, simulation->ground().grains->count());
}

TEST(LeaveOut, PlannedMemoryIsWhatIsTaken) {
  for (const char* friction : {"material.soil.friction=0.5", "material.soil.friction=0"}) {
    const scene::Scene scene = bed({friction, "terrain.size=[1.2, 1.2]", "terrain.layers=6",
                                    "terrain.settle_time_limit=0.6", "terrain.settle_kinetic_energy=0.01"});
    Simulation simulation(setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {});
    terrain::Grains& grains = *simulation.ground().grains;
    grains.refreshNeighbours();
    const double taken = static_cast<double>(grains.system().deviceBytes()) / static_cast<double>(grains.count());
    const std::string line = planLine(scene, "memory for grains");
    const double planned = std::stod(line.substr(line.find("MiB, ") + 5));
    // A settled bed is assumed; a thin one has fewer neighbours.
    EXPECT_NEAR(planned, taken, 0.15 * taken) << friction;
  }
}

TEST(LeaveOut, PlannedContactHistoryIsThatOfFriction) {
  EXPECT_NE(planLine(bed(), "contact history").find(" 96"), std::string::npos) << planLine(bed(), "contact history");
  EXPECT_NE(planLine(bed({"material.soil.friction=0", "terrain.wall_friction=0"}), "contact history").find(" 0"),
            std::string::npos);
}

TEST(LeaveOut, GrainsAloneHaveNoBoundaries) {
  const scene::Scene free =
      setup::parseScene("version = 1\n[run]\nduration = 0.1\ntime_step = 1e-5\n[material.glass]\n[[grain]]\n"
                        "position = [0, 0, 1]\nradius = 0.01\nmaterial = \"glass\"\n",
                        "free.toml");
  const auto simulation = made(free);
  const terrain::GrainState state = simulation->ground().grains->state();
  EXPECT_TRUE(state.wallBits.empty());
  EXPECT_TRUE(state.wallShear.empty());
}

} // namespace
} // namespace grouser::coupling
