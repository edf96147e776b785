// SPDX-License-Identifier: BSD-3-Clause
// Grains beyond the memory of the machine cause an error at their key, before initial placement.
#include "runs/setup/size_checks.hpp"

#include "base/error.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/message_of.hpp"

#include <gtest/gtest.h>

#include <string>

namespace grouser::setup {
namespace {

using test::messageOf;

scene::Scene sceneOf(const std::string& text) { return parseScene("version = 1\n" + text, "scene.toml"); }

/// Grains in a cube of this edge [m], some 1.5 kB each with all planes within their reach.
scene::Scene fill(const std::string& edge) {
  std::string planes;
  for (int k = 0; k < 30; ++k) planes += "[[plane]]\npoint = [0, 0, -100]\nmaterial = \"glass\"\n";
  return sceneOf("[run]\nduration = 1\n[material.glass]\nstiffness = 1e4\nrolling_friction = 0.1\n[[grains]]\nform = "
                 "\"lattice\"\nlow = [0, 0, 0]\nhigh = [" +
                 edge + ", " + edge + ", " + edge + "]\nradius = 0.01\nmaterial = \"glass\"\n" + planes);
}

TEST(SizeChecks, AMechanismHasNoFillsToCount) {
  const scene::Scene pendulum = sceneOf(
      "[run]\nduration = 1\ntime_step = 1e-3\n[[body]]\nname = \"bob\"\nmass = 1\nbox = [1, 1, 1]\nposition = "
      "[0, 0, -1]\n[[joint]]\nname = \"pin\"\ntype = \"revolute\"\nbodies = [\"world\", \"bob\"]\npoint = [0, 0, "
      "0]\naxis = [0, 1, 0]\n");
  ASSERT_FALSE(pendulum.mechanism.empty());
  EXPECT_NO_THROW(checkFillSizes(pendulum));
  EXPECT_NO_THROW(checkBedSize(pendulum));
}

TEST(SizeChecks, AFillBeyondAllMemoryNamesItsKey) {
  EXPECT_EQ(messageOf([] { checkFillSizes(fill("1")); }), "");
  // Four billion: more than the memory of any machine.
  const std::string message = messageOf([] { checkFillSizes(fill("33")); });
  EXPECT_NE(message.find("scene.toml:11: grains.0.radius"), std::string::npos) << message;
  EXPECT_NE(message.find("use fewer or larger grains"), std::string::npos) << message;
}

TEST(SizeChecks, ASetupAsksOnceUnlessItsCallerHas) {
  EXPECT_NE(messageOf([] { groundSetup(fill("33"), 1e-5); }).find("grains.0.radius"), std::string::npos);
  const scene::Scene small = fill("0.1");
  const coupling::SimulationSetup asked = simulationSetup(small), known = simulationSetup(small, 1, SizeChecks::passed);
  EXPECT_EQ(asked.ground.grains->start.size(), known.ground.grains->start.size());
}

} // namespace
} // namespace grouser::setup
