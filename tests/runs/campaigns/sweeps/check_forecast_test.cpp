// SPDX-License-Identifier: BSD-3-Clause
// Note of a run about checks of its scene.
#include "runs/campaigns/sweeps/check_beds.hpp"
#include "runs/campaigns/sweeps/check_goals.hpp"
#include "runs/campaigns/sweeps/kept_checks.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace grouser::sweeps {
namespace {

const std::filesystem::path kQuickStart = std::filesystem::path(GROUSER_SOURCE_DIR) / "runs/scenes/ball_pit.toml";

TEST(CheckForecast, AFirstLookTakesAboutTheRunsOfItsCases) {
  const scene::Scene scene = setup::loadScene(kQuickStart, {});
  CheckCases cases = checkCases(kQuickStart, {}, scene);
  keepGoalCases(cases, {});
  double runs = 0;
  for (const CheckCase& c : cases.cases)
    if (c.refused.empty()) runs += c.cost;
  // The forecast loads no scene: it counts grains by volume; converted parts cost about as much more.
  EXPECT_NEAR(runsOfBarCases(scene, 3), 3 * runs, 0.15 * 3 * runs);
  EXPECT_LT(runsOfBarCases(scene, 3), 0.4 * runsOfWholeCheck(scene, 8));
}

TEST(CheckForecast, WhereAVehicleDrivesOnGrainsTheCheaperCheckIsNamedFirst) {
  const scene::Scene scene = setup::loadScene(kQuickStart, {"run.gravity=[0, 0, -9.8]"}); // never checked
  const double runs = runsOfBarCases(scene, 3);
  const std::string note = checkNote(scene, "", 3600 / runs);
  EXPECT_NE(note.find("for sinkage and torque (at least 1 h 00 min; "), std::string::npos) << note;
  EXPECT_NE(note.find(" --bar 20% --of sinkage,torque\n"), std::string::npos) << note;
}

TEST(CheckBeds, SkinAndSpheresOfThePartsSettleOnTheBedOfTheBase) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("grouser_beds_{}", getpid());
  setenv("GROUSER_CACHE", folder.c_str(), 1);
  const CheckCases cases = checkCases(kQuickStart, {}, setup::loadScene(kQuickStart, {}));
  const std::vector<int> numbers = CheckBeds(kQuickStart, {}, cases).numbers();
  setenv("GROUSER_CACHE", "", 1);
  std::filesystem::remove_all(folder);
  for (std::size_t c = 0; c < numbers.size(); ++c) {
    const CheckAxis axis = cases.cases[c].axis;
    const bool shares = axis == CheckAxis::skin || axis == CheckAxis::spheres;
    EXPECT_EQ(numbers[c], shares ? 0 : static_cast<int>(c)) << cases.cases[c].name;
  }
}

TEST(ShippedChecks, AreOfTheScenesAsTheyStand) {
  const std::filesystem::path scenes = std::filesystem::path(GROUSER_SOURCE_DIR) / "runs/scenes";
  int found = 0;
  for (const auto& file : std::filesystem::directory_iterator(scenes / "checks")) {
    const scene::Scene scene = setup::loadScene(scenes / file.path().stem().concat(".toml"), {});
    const std::string inputs = setup::inputsOf(scene), note = checkNote(scene, inputs, 1, true);
    EXPECT_NE(note.find("checked   error bars from "), std::string::npos)
        << "run grouser check again: " << file << note;
    EXPECT_NE(note.find("speed [m/s]"), std::string::npos) << note;
    // Another speed makes another scene.
    const scene::Scene other = setup::loadScene(scene.file, {"driver.sprocket_speed=3.5"});
    EXPECT_EQ(checkNote(other, setup::inputsOf(other), 1).find("checked "), std::string::npos);
    ++found;
  }
  EXPECT_GE(found, 1);
}

} // namespace
} // namespace grouser::sweeps
