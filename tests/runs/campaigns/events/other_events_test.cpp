// SPDX-License-Identifier: BSD-3-Clause
// Comparison of sets of events, with verdicts.
#include "runs/campaigns/events/other_events.hpp"

#include "base/error.hpp"
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace grouser::events {

using namespace test; // fixtures

namespace {

constexpr const char* kGranular = R"({"vehicle": "light_tracked", "soil": "lete_sand", "ground": "granular", "draws": 0,
  "speed_m_s": 1.2, "rows": [
  {"event": "drawbar", "level": 0.2, "each": [1, 2, 3], "figures": [
    {"name": "drawbar pull [N]", "values": [17000, 18000, 19000], "doubt": ""},
    {"name": "slip [-]", "values": [0.2, 0.2005, 0.1995], "doubt": ""},
    {"name": "speed [m/s]", "values": [0.96, 0.961, 0.959], "doubt": "few teeth"},
    {"name": "motion resistance [N]", "values": [4000], "doubt": ""}]},
  {"event": "pivot_turn", "level": null, "each": [1, 2, 3], "figures": [
    {"name": "rate over commanded [-]", "values": [0.79, 0.80, 0.81], "doubt": ""}]}]})";

using EventSetFile = ProgramTest;

EventSet granular(const std::filesystem::path& folder) {
  std::ofstream(folder / "events.json") << kGranular;
  return readEventSet(folder);
}

EventSet deformable() {
  EventSet set{"", "light_tracked", "lete_sand", "scm", 1.2, false, {}};
  set.figures = {{Event::drawbar, 0.2, "drawbar pull [N]", {24000}, 1, false},
                 {Event::drawbar, 0.2, "slip [-]", {0.201}, 1, false},
                 {Event::drawbar, 0.2, "speed [m/s]", {0.96}, 1, false},
                 {Event::drawbar, 0.2, "motion resistance [N]", {4100}, 1, false},
                 {Event::drawbar, 0.4, "drawbar pull [N]", {26000}, 1, false},
                 {Event::pivotTurn, 0, "rate over commanded [-]", {0.83}, 1, false}};
  return set;
}

TEST_F(EventSetFile, GivesDifferencesWithVerdicts) {
  const EventSet other = granular(folder_);
  const std::vector<FigureDifference> all = differencesFrom(deformable(), other, 5);
  ASSERT_EQ(all.size(), 5u) << "no pull at 40 % slip in the other set";
  EXPECT_EQ(all[0].difference.value, 6000);
  EXPECT_NEAR(all[0].difference.halfWidth, 4.3027 * 1000 / std::sqrt(3), 1) << "Student's interval of three seeds";
  EXPECT_EQ(all[0].verdict, "differs");
  EXPECT_EQ(all[1].verdict, "equal");
  EXPECT_EQ(all[2].verdict, "inconclusive") << "too little driving";
  EXPECT_EQ(all[3].verdict, "inconclusive") << "one seed has no interval";
  EXPECT_EQ(all[4].verdict, "inconclusive") << "the interval includes the limit";
  EXPECT_EQ(differencesFrom(deformable(), other, 60)[0].verdict, "equal") << "the limit";
  const std::string text = differencesText(all, deformable(), other, 5);
  EXPECT_NE(text.find("1 of 3"), std::string::npos) << "the resistance is from one run: " << text;
  EXPECT_EQ(text.find("WARNING"), std::string::npos) << text;
  EXPECT_NE(differencesCsv(all, other, true).find("drawbar,0.2,drawbar pull [N],24000,0,1,18000,"), std::string::npos)
      << differencesCsv(all, other, true);
}

TEST_F(EventSetFile, TwoSeededSetsHaveWelchsInterval) {
  EventSet here = granular(folder_);
  here.figures[0].values = {19000, 20000, 21000};
  const FigureDifference d = differencesFrom(here, granular(folder_), 5)[0];
  EXPECT_EQ(d.difference.value, 2000);
  EXPECT_NEAR(d.difference.halfWidth, 2.7764 * 1000 * std::sqrt(2.0 / 3), 1) << "four degrees of freedom";
}

TEST_F(EventSetFile, DrawsCountWithTheIntervalOfOneMore) {
  EventSet here = deformable();
  here.drawn = true, here.figures[0].values = {23000, 24000, 25000}, here.figures[0].planned = 3;
  const FigureDifference d = differencesFrom(here, granular(folder_), 5)[0];
  EXPECT_NEAR(d.ofHere.halfWidth, 4.3027 * 1000 * std::sqrt(1 + 1.0 / 3), 1);
  EXPECT_NEAR(d.difference.halfWidth, 4.3027 * 1000 * std::sqrt(1 + 2.0 / 3), 1);
}

TEST_F(EventSetFile, WarnsOfOtherVehiclesAndSpeeds) {
  EventSet here = deformable();
  here.vehicle = "robot", here.speed = 0.7;
  const std::string text = differencesText({}, here, granular(folder_), 5);
  EXPECT_NE(text.find("WARNING: different vehicle: robot and light_tracked\n"), std::string::npos) << text;
  EXPECT_NE(text.find("WARNING: different commanded speed [m/s]: 0.7 and 1.2\n"), std::string::npos) << text;
}

TEST_F(EventSetFile, RefusesFoldersWithoutResults) {
  const auto fault = [this]() -> std::string {
    try {
      readEventSet(folder_);
      return "";
    } catch (const base::InputError& error) {
      return error.what();
    }
  };
  EXPECT_NE(fault().find("contains no events.json; specify the results folder"), std::string::npos) << fault();
  std::ofstream(folder_ / "events.json") << R"({"vehicle": 3)";
  EXPECT_NE(fault().find("is damaged"), std::string::npos) << fault();
  const Outcome o = call("events --only acceleration --against nowhere --out out");
  EXPECT_EQ(o.code, 2);
  EXPECT_EQ(o.error().find("--against nowhere: contains no events.json"), 0u) << o.errors;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

} // namespace

} // namespace grouser::events
