// SPDX-License-Identifier: BSD-3-Clause
// Contacts of a pressed grain, oscillations under tension, and checks of a vehicle's bodies during the run.
#include "base/error.hpp"
#include "coupling/pressed_grain.hpp"
#include "coupling/simulation.hpp"
#include "coupling/swing_growth.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/system/guard_scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::coupling {
namespace {

using namespace test; // pieces of scenes

TEST(SwingGrowth, CountsWhatLastsAndNoPeak) {
  SwingGrowth growth;
  for (int k = 0; k < 10; ++k) { // every other check is a peak
    EXPECT_TRUE(growth.bears(3, 50));
    EXPECT_TRUE(growth.bears(0.9, 50));
  }
  // (1.05 + sqrt(1.05^2 - 1))^2 = 1.877 per step: a million within 22 steps, from the second check.
  EXPECT_TRUE(growth.bears(1.05, 50));
  EXPECT_FALSE(growth.bears(1.05, 50));
  SwingGrowth slow;
  EXPECT_TRUE(slow.bears(1.0001, 50));
  EXPECT_TRUE(slow.bears(1.0001, 50)); // 1.0287 per step
  const std::vector<double> saved = slow.save();
  EXPECT_NEAR(saved[0], 1.0287, 1e-4);
  EXPECT_NEAR(saved[1], std::pow(saved[0], 50), 1e-9 * saved[1]);
  SwingGrowth resumed;
  resumed.restore(saved[0], saved[1]);
  EXPECT_EQ(resumed.save(), saved);
}

PressedGrain pressedIn(const std::string& text, std::uint32_t id) {
  const scene::Scene scene = setup::parseScene(text, "scene.toml");
  const SimulationSetup setup = setup::simulationSetup(scene);
  const LaidGround ground = buildGround(setup.ground, base::cpuExec(1));
  return pressedGrain(
      *ground.grains, setup.ground, [&](std::size_t i) { return setup.ground.surfaces[i].start; }, id);
}

TEST(PressedGrain, NamesWhatTouchesItDeepestFirst) {
  const std::string scene = run(1) + soil(0.5, 0.5) + floor() + grain("[0, 0, 0.0048]") + grain("[0.0096, 0, 0.005]") +
                            box("[0, 0, 0.0145]", "[0.02, 0.02, 0.01]", "name = \"lid\"\n");
  const PressedGrain pressed = pressedIn(scene, 0);
  ASSERT_EQ(pressed.by.size(), 3u);
  EXPECT_EQ(pressed.by[0].name, "grain 1");
  EXPECT_NEAR(pressed.by[0].overlap, 0.01 - std::hypot(0.0096, 0.0002), 1e-9);
  EXPECT_NEAR(pressed.by[0].normal.x, -1, 1e-3);
  EXPECT_EQ(pressed.sentence(), "it is pinched between box 'lid' (0.3 mm) and plane 0 (0.2 mm)");
  EXPECT_EQ(pressedIn(scene, 1).sentence(), "it is pressed by box 'lid' (0.5 mm), grain 0 (0.4 mm)");
}

TEST(PressedGrain, NeighboursAcrossAPeriodicBoundaryPressIt) {
  const std::string sides = "periodic = [true, false]\ndomain_x = [0, 0.1]\n";
  const PressedGrain pressed =
      pressedIn(run(1, sides) + soil(0.5, 0.5) + grain("[0.004, 0, 1]") + grain("[0.0945, 0, 1]"), 0);
  ASSERT_EQ(pressed.by.size(), 1u);
  EXPECT_EQ(pressed.by[0].name, "grain 1");
  EXPECT_NEAR(pressed.by[0].overlap, 0.0005, 1e-9);
  EXPECT_NEAR(pressed.by[0].normal.x, 1, 1e-9);
}

TEST(PressedGrain, FallsWhereItTouchesNothingAndGoesDown) {
  const PressedGrain falls{{}, {1, 0, -5}, 0.01, {}}, flies{{}, {5, 0, -1}, 0.01, {}},
      rests{{}, {0, 0, -1}, 0.01, {{"plane 0", 1e-3, {0, 0, 1}}}};
  EXPECT_TRUE(falls.fallsFreely({0, 0, -9.81}));
  EXPECT_FALSE(falls.fallsFreely({}));
  EXPECT_FALSE(flies.fallsFreely({0, 0, -9.81}));
  EXPECT_FALSE(rests.fallsFreely({0, 0, -9.81}));
}

} // namespace
} // namespace grouser::coupling
