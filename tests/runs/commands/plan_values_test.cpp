// SPDX-License-Identifier: BSD-3-Clause
// Numbers printed by `grouser plan`, compared with the numbers in the scene.
#include "runs/commands/plan.hpp"

#include "base/math.hpp"
#include "runs/campaigns/forecast/elastic_layer.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/step_limit.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace grouser::commands {
namespace {

/// Text after `what` in its line: the last one, because active features come first.
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
  EXPECT_EQ(after(plan, "maximum time step"), fmt::format("{:.4g} s (20 steps per contact)", contact / 20));
  EXPECT_EQ(after(plan, "time step"), fmt::format("4e-06 s, {:.1f} steps per contact", contact / 4e-6));
}

TEST(PlanValues, VehicleIsWeighedAndMeasured) {
  const std::string plan = planText(setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/rigid.toml"));
  EXPECT_EQ(after(plan, "vehicle"), "5018 kg, 2 x 46 shoes, pitch radius 0.2451 m");
  EXPECT_EQ(after(plan, "steps"), "40000 for 4 s");
}

TEST(PlanValues, StableStepsOfAVehicleAreSorted) {
  const scene::Scene scene = setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/rigid.toml");
  const std::string plan = planText(scene);
  const std::size_t at = plan.find("  stable steps of the vehicle\n"), first = plan.find('\n', at) + 1;
  ASSERT_NE(at, std::string::npos);
  const std::string line = plan.substr(first, plan.find('\n', first) - first);
  const setup::StepLimit limit = setup::stepLimit(scene);
  EXPECT_NE(line.find(limit.what), std::string::npos) << line;
  EXPECT_NEAR(std::stod(line.substr(line.find_last_of(' ', line.size() - 3))), limit.step, 1e-2 * limit.step);
  for (const char* contact :
       {"idler in contact with ", "road wheel of ", "roller of ", "joints, torsion bars, tensioner"})
    EXPECT_NE(plan.find(contact, at), std::string::npos) << contact;
}

TEST(PlanValues, DepthOfTheBedIsToldByAnElasticLayerUnderTheTracks) {
  // The light vehicle: five road wheels 0.4458 m apart, pads 0.28 m wide, tracks 1.9 m apart.
  const std::vector<forecast::LoadedRectangle> two = {{0, 0.95, 0.8916, 0.14}, {0, -0.95, 0.8916, 0.14}};
  const std::string scene = std::string(GROUSER_SOURCE_DIR) + "/runs/scenes/soil_coarse.toml";
  const auto share = [](const std::vector<forecast::LoadedRectangle>& tracks, double depth) {
    return 100 * forecast::layerSettlement(tracks, depth, 0.25) /
           forecast::layerSettlement(tracks, base::kInfinity, 0.25);
  };
  const auto printed = [&](const std::vector<forecast::LoadedRectangle>& tracks) {
    return fmt::format(
        "0.4 m: an elastic layer settles {:.0f} % as much as a half-space under these tracks; 0.8 m: {:.0f} %",
        share(tracks, 0.4), share(tracks, 0.8));
  };
  EXPECT_EQ(after(planText(setup::loadScene(scene, {"terrain.depth=0.4"})), "bed depth"), printed(two));
  EXPECT_EQ(after(planText(setup::loadScene(scene, {"terrain.depth=0.75"})), "bed depth"),
            "0.75 m: an elastic layer settles 49 % as much as a half-space under these tracks; 1.5 m: 64 %");
  EXPECT_EQ(
      after(planText(setup::loadScene(scene, {"terrain.depth=0.4", "vehicle.tracks=single", "vehicle.chassis=guided"})),
            "bed depth"),
      printed({two[0]}));
}

} // namespace
} // namespace grouser::commands
