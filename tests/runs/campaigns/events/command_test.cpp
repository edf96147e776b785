// SPDX-License-Identifier: BSD-3-Clause
// `grouser events` from the command line: one event for half a second, its tables, and a second call that skips
// finished runs.
#include "tests/runs/program_fixture.hpp"
#include "tests/runs/shared_cache.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace grouser::events {

using namespace test; // fixtures

namespace {

using EventsProgram = ProgramTest;

TEST_F(EventsProgram, WritesItsTablesAndGoesOn) {
  const std::string words = "events --only acceleration --set run.duration=0.7 --set driver.drive_start=0.46 "
                            "--set vehicle.sphere_radius=0.04 --set output.picture=false --threads 1 --out out";
  const Outcome first = call(words, withSharedCache());
  ASSERT_EQ(first.code, 0) << first.errors;
  EXPECT_NE(first.out.find("incomplete"), std::string::npos) << first.out; // too little time for 5 m
  const auto json = nlohmann::json::parse(contents(folder_ / "out" / "events.json"));
  ASSERT_EQ(json["rows"].size(), 1u);
  EXPECT_EQ(json["rows"][0]["event"], "acceleration");
  EXPECT_EQ(json["rows"][0]["verdict"], "incomplete");
  EXPECT_EQ(json["rows"][0]["scene"], "event_acceleration.toml");
  ASSERT_EQ(json["rows"][0]["each"].size(), 1u);
  EXPECT_EQ(json["rows"][0]["each"][0]["verdict"], "incomplete");
  EXPECT_EQ(json["rows"][0]["each"][0]["why"], json["rows"][0]["why"]);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / json["rows"][0]["each"][0]["run"].get<std::string>()));
  EXPECT_NE(contents(folder_ / "out" / "events.csv").find("run.duration ends the drive after 0."), std::string::npos);
  EXPECT_FALSE(contents(folder_ / "out" / "events.txt").empty());

  const Outcome other = call(words + " --speed 1");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.errors.find("continue with --resume"), std::string::npos) << other.errors;
  for (const char* more : {"", " --resume"}) {
    const Outcome again = call(words + more);
    EXPECT_EQ(again.code, 0) << again.errors;
    EXPECT_NE(again.out.find("already finished"), std::string::npos) << again.out;
  }
}

TEST_F(EventsProgram, EndsWithTwoAndOneLineWhereAWordIsWrong) {
  for (const char* words : {"--only jump", "--vehicle tank", "--soil cheese", "--levels 0.3", "--seeds 2",
                            "--only step --levels 0.3,0.3", "--set terrain.colour=red", "--speed -1", "--part 3/2"}) {
    const Outcome o = call(std::string("events ") + words);
    EXPECT_EQ(o.code, 2) << words;
    EXPECT_FALSE(o.error().empty()) << words << ": " << o.errors;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out")) << words;
  }
}

TEST_F(EventsProgram, SaysThatFilmsCannotBeMadeBeforeItRuns) {
  const Outcome o = call("events --only acceleration --films --out out", "export PATH=/nowhere; ");
  EXPECT_EQ(o.code, 2);
  EXPECT_EQ(o.error().find("--films: films require ffmpeg"), 0u) << o.errors;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

} // namespace

} // namespace grouser::events
