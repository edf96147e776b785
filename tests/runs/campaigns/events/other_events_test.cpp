// SPDX-License-Identifier: BSD-3-Clause
// Figures of events beside those of another ground.
#include "runs/campaigns/events/other_events.hpp"

#include "base/error.hpp"
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace grouser::events {

using namespace test; // fixtures

namespace {

constexpr const char* kGranular = R"({"vehicle": "light_tracked", "soil": "lete_sand", "ground": "granular", "rows": [
  {"event": "drawbar", "level": 0.2, "figures": [
    {"name": "drawbar pull [N]", "mean": 18000, "half_width": 3000},
    {"name": "slip [-]", "mean": 0.2, "half_width": 0.001},
    {"name": "motion resistance [N]", "mean": 4000, "half_width": null}]},
  {"event": "pivot_turn", "level": null, "figures": [
    {"name": "rate over commanded [-]", "mean": 0.8, "half_width": 0.04}]}]})";

using OtherEventsFile = ProgramTest;

OtherEvents granular(const std::filesystem::path& folder) {
  std::ofstream(folder / "events.json") << kGranular;
  return readOtherEvents(folder);
}

TEST_F(OtherEventsFile, GivesDifferencesWithVerdicts) {
  const OtherEvents other = granular(folder_);
  EXPECT_EQ(other.ground, "lete_sand (granular)");
  const std::vector<LevelFigure> here = {{Event::drawbar, 0.2, "drawbar pull [N]", {24000, 0}},
                                         {Event::drawbar, 0.2, "slip [-]", {0.201, 0}},
                                         {Event::drawbar, 0.2, "motion resistance [N]", {4100, 0}},
                                         {Event::drawbar, 0.4, "drawbar pull [N]", {26000, 0}},
                                         {Event::pivotTurn, 0, "rate over commanded [-]", {0.83, 0.03}}};
  const std::vector<FigureBeside> both = besides(here, other, 5);
  ASSERT_EQ(both.size(), 4u) << "no pull at 40 % slip in the other";
  EXPECT_EQ(both[0].difference.value, 6000);
  EXPECT_EQ(both[0].difference.halfWidth, 3000);
  EXPECT_EQ(both[0].verdict, "differs");
  EXPECT_EQ(both[1].verdict, "equal");
  EXPECT_EQ(both[2].verdict, "inconclusive") << "one seed has no interval";
  EXPECT_DOUBLE_EQ(both[3].difference.halfWidth, 0.05) << "root of the sum of both squares";
  EXPECT_EQ(both[3].verdict, "inconclusive");
  EXPECT_NE(besidesCsv(both, other, true).find("drawbar,0.2,drawbar pull [N],24000,0,18000,3000,6000,3000,differs\n"),
            std::string::npos)
      << besidesCsv(both, other, true);
  EXPECT_EQ(besides(here, other, 60)[0].verdict, "equal") << "the bar";
}

TEST_F(OtherEventsFile, RefusesFoldersWithoutResults) {
  const auto fault = [this]() -> std::string {
    try {
      readOtherEvents(folder_);
      return "";
    } catch (const base::InputError& error) {
      return error.what();
    }
  };
  EXPECT_NE(fault().find("holds no events.json; name the folder of a `grouser events`"), std::string::npos) << fault();
  std::ofstream(folder_ / "events.json") << R"({"vehicle": 3)";
  EXPECT_NE(fault().find("is damaged"), std::string::npos) << fault();
  const Outcome o = call("events --only acceleration --against nowhere --out out");
  EXPECT_EQ(o.code, 2);
  EXPECT_EQ(o.error().find("--against nowhere: holds no events.json"), 0u) << o.errors;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

} // namespace

} // namespace grouser::events
