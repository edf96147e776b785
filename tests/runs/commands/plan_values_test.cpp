// SPDX-License-Identifier: BSD-3-Clause
// Numbers that `grouser plan` promises, against the scene's own.
#include "runs/commands/plan.hpp"

#include "base/math.hpp"
#include "runs/setup/load_scene.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace grouser::commands {
namespace {

/// What stands behind `what` in its line: the last one, for what is switched on and off comes first.
std::string after(const std::string& text, const std::string& what) {
  const std::size_t at = text.rfind("  " + what + " ");
  if (at == std::string::npos) return "no such line";
  const std::size_t from = text.find_first_not_of(' ', at + 2 + what.size());
  return text.substr(from, text.find('\n', from) - from);
}

TEST(PlanValues, StepsAndContactsAreThoseOfTheScene) {
  std::string scene = "version = 1\n[run]\nduration = 0.5\ntime_step = 4e-6\n[material.glass]\nstiffness = 2e5\n"
                      "density = 2500\nfriction = 0\nrestitution = 1\n";
  for (int i = 0; i < 3; ++i)
    scene += fmt::format("[[grain]]\nposition = [{}, 0, 0]\nradius = 0.01\nmaterial = \"glass\"\n", 0.1 * i);
  const std::string plan = planText(setup::parseScene(scene, "plan.toml"));
  const double mass = 2500 * 4.0 / 3 * base::kPi * 1e-6, contact = base::kPi * std::sqrt(mass / 2 / 2e5);
  EXPECT_EQ(after(plan, "grains"), "3");
  EXPECT_EQ(after(plan, "steps"), "125000 for 0.5 s");
  EXPECT_EQ(after(plan, "grain steps"), "3.75e+05");
  EXPECT_EQ(after(plan, "shortest grain contact"), fmt::format("{:.4g} s", contact));
  EXPECT_EQ(after(plan, "largest sound step"), fmt::format("{:.4g} s (20 steps a contact)", contact / 20));
  EXPECT_EQ(after(plan, "time step"), fmt::format("4e-06 s, {:.1f} a contact", contact / 4e-6));
}

TEST(PlanValues, VehicleIsWeighedAndMeasured) {
  const std::string plan = planText(setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/rigid.toml"));
  EXPECT_EQ(after(plan, "vehicle"), "5018 kg, 2 x 46 shoes, pitch radius 0.2451 m");
  EXPECT_EQ(after(plan, "steps"), "40000 for 4 s");
}

} // namespace
} // namespace grouser::commands
