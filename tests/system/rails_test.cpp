// SPDX-License-Identifier: BSD-3-Clause
// A hull on rails, over both tracks or a single one, on rigid ground.
#include "base/error.hpp"
#include "runs/setup/load_scene.hpp"
#include "tests/system/driven_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fmt/format.h>

namespace grouser::coupling {
namespace {

scene::Scene onRails(const std::string& vehicle, const std::string& more = {}) {
  return setup::parseScene(
      fmt::format("version = 1\n[run]\nduration = 4\ntime_step = 1e-4\n[material.steel]\nstiffness = 1e6\n"
                  "friction = 0.5\n[terrain]\nkind = \"rigid\"\nheightmap = \"heightmaps/flat.png\"\nsize = [9, 8]\n"
                  "height_range = [0, 0]\nmaterial = \"steel\"\n[vehicle]\nspec = \"vehicles/light_tracked.toml\"\n"
                  "sphere_radius = 0.03\nhull_touches = false\nposition = [2, 0]\nheading = 20\n{}\n[driver]\n"
                  "sprocket_speed = 2\n{}",
                  vehicle, more),
      GROUSER_SOURCE_DIR "/tests/scenes/rigid.toml");
}

const char* const kHalf = "[spec.chassis]\nmass = 1850.0\ninertia = [1025.0, 2000.0, 2110.0]\n";

TEST(OnRails, ASingleTrackDrivesStraightUnderItsLoad) {
  Simulation simulation = begin(onRails("tracks = \"single\"\nchassis = \"guided\"", kHalf));
  const vehicle::Assembly& assembly = simulation.vehicle()->assembly();
  ASSERT_EQ(assembly.tracks.size(), 1u);
  EXPECT_EQ(assembly.tracks[0].y, 0);
  advance(simulation, 1.5);
  simulation.restartMeans();
  const vehicle::Observation before = simulation.vehicle()->observe();
  const double rising = simulation.ledger().momentum.z;
  constexpr double kTeeth = 3 * 0.314159; // [s] duration of three teeth
  advance(simulation, 1.5 + kTeeth);
  const vehicle::Observation seen = simulation.vehicle()->observe();
  const double weight = assembly.mass * 9.81, heading = 20 * std::atan(1.0) / 45;
  std::printf("single track: ground force / weight %.5f, speed %.4f m/s, pitch %.4f rad\n", seen.groundForce.z / weight,
              norm(seen.position - before.position), seen.pitchAngle);
  const double gained = (simulation.ledger().momentum.z - rising) / kTeeth;
  EXPECT_NEAR((seen.groundForce.z - gained) / weight, 1, 2e-4) << "the rails carry the carriage, 1e-4 of the hull";
  EXPECT_NEAR(seen.heading, heading, 1e-8) << "joint tolerance";
  EXPECT_NEAR(seen.rollAngle, 0, 1e-8);
  const base::Vec3d way = seen.position - before.position;
  EXPECT_NEAR(-std::sin(heading) * way.x + std::cos(heading) * way.y, 0, 1e-8);
  const double paid = 2 * assembly.spec.pitchRadius() * kTeeth;
  EXPECT_NEAR(norm(way), paid, 0.03 * paid) << "oscillating pitch, and slip";
  EXPECT_NE(seen.pitchAngle, 0);
  const Ledger l = simulation.ledger();
  EXPECT_LT(std::fabs(l.residual), 1e-9 * l.turnover);
}

TEST(OnRails, ALevelHullDoesNotPitchAsItPulls) {
  double pitch[2];
  for (const int level : {0, 1}) {
    Simulation simulation =
        begin(onRails(fmt::format("tracks = \"single\"\nchassis = \"{}\"", level ? "level" : "guided"),
                      std::string("[hitch]\nkind = \"speed\"\nslip = 0.4\n") + kHalf));
    advance(simulation, 1.2);
    pitch[level] = simulation.vehicle()->observe().pitchAngle;
  }
  std::printf("pitch under the pull: %.5f rad, held %.2g rad\n", pitch[0], pitch[1]);
  EXPECT_GT(std::fabs(pitch[0]), 1e-3);
  EXPECT_LT(std::fabs(pitch[1]), 1e-8);
}

/// Both tracks on one straight line, although their speeds differ.
TEST(OnRails, AHullDoesNotYawThoughItsTracksWantTo) {
  scene::Scene scene = onRails("chassis = \"guided\"");
  scene.driver.sprocketSpeed.reset(), scene.driver.left = 1, scene.driver.right = 3;
  Simulation simulation = begin(scene);
  advance(simulation, 1.5);
  EXPECT_NEAR(simulation.vehicle()->observe().heading, 20 * std::atan(1.0) / 45, 1e-8);
  EXPECT_GT(norm(simulation.vehicle()->observe().velocity), 0.2);
}

TEST(OnRails, ASingleTrackUnderAFreeHullIsRefused) {
  for (const auto& [text, word] :
       {std::pair{std::string("tracks = \"single\""), "vehicle.tracks"}, {std::string("tracks = \"three\""), "both"}}) {
    try {
      onRails(text);
      FAIL() << "accepted: " << text;
    } catch (const base::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }
}

} // namespace
} // namespace grouser::coupling
