// SPDX-License-Identifier: BSD-3-Clause
// A vehicle on rigid surfaces: it rests on a box as on ground, on a log with its hull, climbs a step; identical
// results.
#include "base/error.hpp"
#include "runs/setup/load_scene.hpp"
#include "tests/system/driven_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fmt/format.h>

namespace grouser::coupling {
namespace {

using base::Vec3d;

/// On level rigid ground, 8 m long, at height `ground` [m].
scene::Scene sceneWith(const std::string& more, double ground = 0, const std::string& driver = "sprocket_speed = 0",
                       const std::string& vehicle = {}) {
  return setup::parseScene(
      fmt::format("version = 1\n[run]\nduration = 4\ntime_step = 1e-4\n[material.steel]\nstiffness = 1e6\n"
                  "friction = 0.5\n[terrain]\nkind = \"rigid\"\nheightmap = \"heightmaps/flat.png\"\nsize = [8, 3]\n"
                  "height_range = [{0}, {0}]\nmaterial = \"steel\"\n[vehicle]\n"
                  "spec = \"vehicles/light_tracked.toml\"\nsphere_radius = 0.03\nposition = [1, 0]\n{3}\n[driver]\n"
                  "tension_ramp = 0.02\nweight_ramp = 0.1\ndrive_ramp = 0.05\n{1}\n{2}",
                  ground, driver, more, vehicle),
      GROUSER_SOURCE_DIR "/tests/scenes/obstacles.toml");
}

void stepTo(Simulation& simulation, std::int64_t to) {
  while (simulation.steps() < to) simulation.step();
}

const char* const kPlatform = "[[box]]\nposition = [4, 0, 0.1]\nsize = [8, 3, 0.2]\nmaterial = \"steel\"\n";

TEST(OnABox, RestsAsOnGroundOfThatHeight) {
  Simulation box = begin(sceneWith(kPlatform)), ground = begin(sceneWith("", 0.2));
  stepTo(box, 8000), stepTo(ground, 8000);
  box.restartMeans(), ground.restartMeans();
  stepTo(box, 10000), stepTo(ground, 10000);
  const double weight = box.vehicle()->assembly().mass * 9.81;
  const Vec3d force = box.vehicle()->meanGroundForce();
  std::printf("on a box: ground force / weight = %.6f, on ground %.6f\n", force.z / weight,
              ground.vehicle()->meanGroundForce().z / weight);
  EXPECT_NEAR(force.z / weight, 1, 1e-3);
  EXPECT_NEAR(force.z, ground.vehicle()->meanGroundForce().z, 1e-6 * weight) << "rounding";
  EXPECT_NEAR(box.vehicle()->meanForceOn(0).z, -force.z, 1e-9 * weight) << "the ground below carries no load";
  for (std::size_t b = 0; b < box.vehicle()->state().pose.size(); ++b)
    EXPECT_LT(norm(box.vehicle()->state().pose[b].position - ground.vehicle()->state().pose[b].position),
              b == 0 ? 1e-7 : 2e-6)
        << b << ": rounding; slack strands amplify it to 5e-7 m";
}

TEST(OnABox, SinkageIsMeasuredFromItsTop) {
  Simulation box = begin(sceneWith(kPlatform));
  stepTo(box, 6000);
  int shoes = 0;
  const vehicle::Observation seen = box.vehicle()->observe();
  for (const double sinkage : seen.tracks[0].sinkage) {
    if (!std::isfinite(sinkage)) continue;
    ++shoes;
    EXPECT_NEAR(sinkage, -0.015, 1e-3) << "height of the grousers";
  }
  EXPECT_GT(shoes, 8);
}

/// A log across, between the tracks, above the hull's clearance of 255 mm.
std::string log(double x) {
  return fmt::format("[[cylinder]]\nposition = [{}, 0, 0.02]\naxis = [0, 1, 0]\nradius = 0.3\nlength = 1.4\n"
                     "material = \"steel\"\nname = \"log\"\n",
                     x);
}

TEST(OnALog, TheHullCarriesTheVehicle) {
  Simulation simulation = begin(sceneWith(log(2.43)));
  stepTo(simulation, 15000);
  simulation.restartMeans();
  stepTo(simulation, 20000);
  const vehicle::Assembly& assembly = simulation.vehicle()->assembly();
  const double weight = assembly.mass * 9.81;
  const Vec3d all = simulation.vehicle()->meanGroundForce(), log = simulation.vehicle()->meanForceOn(0);
  std::printf("on a log: all / weight = %.5f, log %.5f\n", all.z / weight, -log.z / weight);
  EXPECT_NEAR(all.z / weight, 1, 0.01);
  EXPECT_LT(log.z, -0.2 * weight);
  // On the log the belly, 200 mm below the vehicle's origin, is at 0.32 m.
  const base::Pose hull = vehicle::partPose(simulation.vehicle()->assembly().parts[0], simulation.vehicle()->state());
  const Vec3d over = hull.toBody({2.43, 0, 0.32});
  EXPECT_NEAR(over.z, -0.2, 2e-3);
  EXPECT_LT(std::fabs(simulation.ledger().residual), 1e-9 * simulation.ledger().turnover);
}

TEST(OnALog, AHullThatTouchesNothingPassesThroughIt) {
  Simulation simulation = begin(sceneWith("[[box]]\nposition = [2.43, 0, 0.16]\nsize = [0.3, 1.4, 0.32]\n"
                                          "material = \"steel\"\n",
                                          0, "sprocket_speed = 0", "hull_touches = false"));
  stepTo(simulation, 6000);
  EXPECT_EQ(simulation.vehicle()->meanForceOn(0), Vec3d{});
}

/// Hash of tests/scenes/obstacles.toml after 7,000 steps: the hull on its log. A change of it is a
/// change of the physics or of its order of operations, and needs a stated reason in the commit.
constexpr const char* kObstaclesHash = "1a6c016504253c07";
constexpr std::int64_t kObstaclesSteps = 7000;

TEST(OneAnswer, OnObstacles) {
  const scene::Scene scene = setup::loadScene(testScene("obstacles.toml"));
  Simulation one = begin(scene, 1), two = begin(scene, 2);
  stepTo(one, 4001), stepTo(two, 4001);
  EXPECT_EQ(two.stateHash(), one.stateHash()) << "threads";
  Simulation resumed(setup::simulationSetup(scene), testExec(2), two.save(), {}, sharedSpheres());
  EXPECT_EQ(resumed.stateHash(), one.stateHash());
  stepTo(one, 6000);
  one.restartMeans();
  stepTo(one, kObstaclesSteps), stepTo(resumed, kObstaclesSteps);
  EXPECT_LT(one.vehicle()->meanForceOn(1).z, -1000) << "the hull slides on the log";
  const Ledger l = one.ledger();
  EXPECT_LT(std::fabs(l.residual), 1e-9 * l.turnover);
  EXPECT_LT(norm(l.momentumResidual), 1e-9 * one.vehicle()->assembly().mass * 9.81 * one.time());
  EXPECT_GT(l.dissipated.parts, 0);
  EXPECT_EQ(one.stateHash(), kObstaclesHash);
  EXPECT_EQ(resumed.stateHash(), kObstaclesHash) << "resumed, on two threads";
}

TEST(OneAnswer, AnObstacleOutOfReachChangesNoBit) {
  const std::string far = "[[box]]\nposition = [7.8, 1, 0.1]\nsize = [0.2, 0.2, 0.2]\nmaterial = \"steel\"\n";
  Simulation with = begin(sceneWith(far)), without = begin(sceneWith(""));
  Simulation bare = begin(sceneWith("", 0, "sprocket_speed = 0", "hull_touches = false"));
  for (Simulation* s : {&with, &without, &bare}) stepTo(*s, 2000);
  EXPECT_EQ(with.stateHash(), without.stateHash());
  EXPECT_EQ(bare.stateHash(), without.stateHash()) << "a hull without contacts";
}

TEST(SetDown, AWallInTheTracksIsRefused) {
  try {
    begin(sceneWith("[[box]]\nposition = [4.1, 0.9, 0.5]\nsize = [0.4, 0.4, 1]\nmaterial = \"steel\"\n"));
    FAIL() << "accepted";
  } catch (const base::InputError& error) {
    const std::string said = error.what();
    for (const char* word : {"obstacles.toml:", "box.0", "overlaps the left shoe", "move it or vehicle.position"})
      EXPECT_NE(said.find(word), std::string::npos) << word << " in: " << said;
  }
}

} // namespace
} // namespace grouser::coupling
