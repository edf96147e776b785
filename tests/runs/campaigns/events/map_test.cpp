// SPDX-License-Identifier: BSD-3-Clause
// `grouser map`: plan, errors, table, and a 2 x 2 map from the command line.
#include "runs/campaigns/events/mobility_map.hpp"

#include "base/error.hpp"
#include "runs/scene/scene.hpp"
#include "tests/runs/program_fixture.hpp"
#include "tests/runs/shared_cache.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace grouser::events {

using namespace test; // fixtures

namespace {

EventOptions slopesOfSand() {
  EventOptions options;
  options.soil = "lete_sand", options.ground = scene::TerrainKind::scm;
  options.only = {"grade"}, options.onlyOption = "--event", options.levels = {0.6, 0.2};
  return options;
}

std::string faultOf(const EventOptions& options, const std::string& axis) {
  try {
    planMap(options, axis);
    return "";
  } catch (const base::InputError& error) {
    return error.what();
  }
}

TEST(MobilityMap, HasARunForEachLevelAndValue) {
  const MobilityMap map = planMap(slopesOfSand(), "scm.c=0,2000,4e3");
  ASSERT_EQ(map.columns.size(), 3u);
  for (const MapColumn& column : map.columns) {
    ASSERT_EQ(column.plan.trials.size(), 2u);
    EXPECT_EQ(column.plan.trials[0].level, 0.2) << "from the easiest";
    EXPECT_DOUBLE_EQ(column.plan.course.constants.cohesion, std::stod(column.value)) << "in the closed form, too";
  }
  const sweeps::SweepRun& last = map.columns[2].plan.sweep.runs[1];
  EXPECT_EQ(last.name, "scm.c=4e3,grade=0.6");
  EXPECT_DOUBLE_EQ(*last.scene.scm->cohesion, 4000);
}

TEST(MobilityMap, RefusesAxesAndEventsOfOneValue) {
  EventOptions options = slopesOfSand();
  EXPECT_EQ(faultOf(options, "scm.c=5"),
            "--axis scm.c=5: requires at least two values; for a single value, use: grouser events "
            "--only grade --set scm.c=5");
  EXPECT_EQ(faultOf(options, "run.gravity=1").find("--axis run.gravity=1: the event grade sets run.gravity itself"), 0u)
      << "no advice that is then refused";
  EXPECT_EQ(faultOf(options, "scm.c"),
            "--axis scm.c: value is missing; write key=value,value..., e.g. --axis scm.c=0,1000,2000");
  EXPECT_EQ(faultOf(options, "scm.c=5,6,5"), "--axis scm.c=5,6,5: 5 is listed twice; remove one");
  EXPECT_EQ(faultOf(options, "scm.colour=1,2").find("--axis scm.colour=1: unknown key scm.colour"), 0u)
      << faultOf(options, "scm.colour=1,2");
  EXPECT_NE(faultOf(options, "scm.c=0,0").find("is listed twice"), std::string::npos);
  EXPECT_NE(faultOf(options, "terrain.material=dry_sand,lete_sand").find("this key has its own option; use --soil"),
            std::string::npos);
  options.levels = {0.3, 0.3000000001};
  EXPECT_NE(faultOf(options, "scm.c=5,6").find("duplicate run name scm.c=5,grade=0.3"), std::string::npos);
  EventOptions rigid;
  rigid.only = {"grade"};
  EXPECT_EQ(faultOf(rigid, "spec.contact.friction_ground=0.4,0.8"),
            "--levels: required, because the default levels differ between the values of --axis");
  options.levels = {0.3};
  EXPECT_EQ(faultOf(options, "scm.c=5,6"), "--levels: a map requires at least two levels");
  options.levels = {}, options.only = {"pivot_turn"};
  EXPECT_EQ(faultOf(options, "scm.c=5,6"), "--event pivot_turn: has no levels to map; use e.g. grade");
  options.only = {"gap"};
  EXPECT_EQ(faultOf(options, "scm.c=5,6").find("--event gap: a gap between slabs does not depend on the soil"), 0u)
      << faultOf(options, "scm.c=5,6");
}

TEST(MobilityMap, RefusesKeysOfTheEvent) {
  EventOptions options;
  options.only = {"drawbar"}, options.levels = {0.1, 0.2};
  EXPECT_EQ(faultOf(options, "hitch.slip=0.1,0.3"),
            "--axis hitch.slip=0.1: the event drawbar sets hitch.slip itself; use --levels");
  options.only = {"grade"};
  EXPECT_EQ(faultOf(options, "run.gravity.2=-9,-2").find("--axis run.gravity.2=-9: the event grade sets run.gravity"),
            0u)
      << faultOf(options, "run.gravity.2=-9,-2");
  options.only = {"step"};
  EXPECT_EQ(faultOf(options, "box.step.size.2=0.1,0.3").find("--axis box.step.size.2=0.1: the event step sets box"), 0u)
      << faultOf(options, "box.step.size.2=0.1,0.3");
}

TEST(MobilityMap, TableHasTheHighestLevelOnTopAndTheLimitOfEachValue) {
  MobilityMap map{"scm.c", Event::grade, {}};
  for (const auto& [value, gos] : {std::pair{"0", std::pair{1, 0}}, {"4000", std::pair{1, 1}}}) {
    MapColumn column;
    column.value = value;
    for (const auto& [level, go] : {std::pair{0.2, gos.first}, {0.6, gos.second}}) {
      EventRow row;
      row.event = Event::grade, row.level = level, row.runs = 1, row.gos = go;
      column.rows.push_back(row);
    }
    map.columns.push_back(std::move(column));
  }
  EXPECT_EQ(mapText(map).substr(0, mapText(map).find("\n\n")), "grade: tan of the slope [-] over scm.c\n"
                                                               "                   0      4000\n"
                                                               "       0.6     no-go        go\n"
                                                               "       0.2        go        go");
  EXPECT_NE(mapText(map).find("scm.c = 0          between 0.2 and 0.6"), std::string::npos) << mapText(map);
  EXPECT_NE(mapText(map).find("scm.c = 4000       above 0.6"), std::string::npos);
}

using MapProgram = ProgramTest;

TEST_F(MapProgram, WritesItsTablesAndGoesOn) {
  const std::string words =
      "map --levels 1.1,1.2 --axis spec.contact.friction_ground=0.4,0.8 --speed 2.4 --set run.duration=0.7 --set "
      "driver.drive_start=0.46 --set driver.drive_ramp=0.02 --set vehicle.sphere_radius=0.04 --set "
      "output.picture=false "
      "--threads 1 --out out";
  const Outcome first = call(words, withSharedCache());
  ASSERT_EQ(first.code, 0) << first.errors;
  const auto json = nlohmann::json::parse(contents(folder_ / "out" / "map.json"));
  ASSERT_EQ(json["columns"].size(), 2u);
  EXPECT_EQ(json["columns"][1]["value"], "0.8");
  ASSERT_EQ(json["columns"][1]["rows"].size(), 2u);
  EXPECT_EQ(json["columns"][1]["rows"][0]["verdict"], "no-go") << "steeper than its friction";
  EXPECT_EQ(json["columns"][1]["limits"][0]["blocks"], 0.8) << "the friction of this value";
  EXPECT_NE(contents(folder_ / "out" / "map.csv").find("0.4,grade,1.1,"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "map.png"));
  const Outcome again = call(words);
  EXPECT_EQ(again.code, 0) << again.errors;
  EXPECT_NE(again.out.find("already finished"), std::string::npos) << again.out;
  EXPECT_EQ(call(words + " --quick").code, 2) << "the folder contains runs of another call";
}

} // namespace

} // namespace grouser::events
