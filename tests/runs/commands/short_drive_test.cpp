// SPDX-License-Identifier: BSD-3-Clause
// Runs of vehicles that never drive, or hardly: warned before and after the run, and not counted as valid.
#include "tests/runs/csv_fixture.hpp"
#include "tests/runs/program_fixture.hpp"
#include "tests/runs/shared_cache.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

class ShortDrive : public ProgramTest {
protected:
  void SetUp() override {
    ProgramTest::SetUp();
    put(folder_ / "scene.toml",
        "version = 1\n[run]\ntime_step = 1e-4\nduration = 0.02\noutput_interval = 0.005\n[material.ground]\n"
        "stiffness = 1e7\n[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [6, 2.6]\nheight_range = [0, 0]\n"
        "kind = \"rigid\"\nmaterial = \"ground\"\n[vehicle]\nspec = \"vehicles/light_tracked.toml\"\n"
        "sphere_radius = 0.04\n[driver]\nsprocket_speed = 2\ntension_ramp = 0\nweight_ramp = 0\n"
        "[output]\nframes = false\nplots = false\npicture = false\n");
  }
  nlohmann::json manifest(const std::string& run) const {
    return nlohmann::json::parse(contents(folder_ / run / "manifest.json"));
  }
};

TEST_F(ShortDrive, IsSaidFirstByPlanAndAtTheEndAndMakesTheRunIncomplete) {
  const std::string late = " --set driver.drive_start=0.05";
  const Outcome plan = call("plan scene.toml --no-probe" + late);
  EXPECT_EQ(plan.code, 0) << plan.errors;
  EXPECT_EQ(
      plan.out.rfind("WARNING: the vehicle never drives (its sprockets start at 0.05 s, the run ends at 0.02 s)", 0),
      0u)
      << plan.out;

  const Outcome run = call("run scene.toml --out never" + late, withSharedCache());
  EXPECT_EQ(run.code, 0) << run.errors;
  const std::string words = "the vehicle never drove (its sprockets start at 0.05 s of 0.02 s); raise run.duration";
  const std::size_t at = run.out.find("WARNING: " + words);
  ASSERT_NE(at, std::string::npos) << run.out;
  for (const char* later : {"blows ", "ledger ", "wall "}) EXPECT_GT(run.out.find(later), at) << run.out;
  EXPECT_EQ(manifest("never")["status"], "incomplete");
  EXPECT_EQ(manifest("never")["incomplete"], words);
  EXPECT_EQ(manifest("never")["steps"], 200) << "its results are complete";
}

TEST_F(ShortDrive, OfLessThanTwoTeethHasInconclusiveFigures) {
  const std::string some = " --set driver.drive_start=0.005 --set driver.drive_ramp=0.005";
  const Outcome run = call("run scene.toml --out some" + some, withSharedCache());
  EXPECT_EQ(run.code, 0) << run.errors;
  EXPECT_NE(run.out.find("WARNING: the vehicle drove 0.04 teeth, fewer than 2 (its sprockets start at 0.005 s of 0.02 "
                         "s), and its figures are inconclusive; raise run.duration"),
            std::string::npos)
      << run.out;
  EXPECT_EQ(manifest("some")["status"], "incomplete");
  // Part of a run counts for the whole.
  ASSERT_EQ(call("run scene.toml --out parts --steps 100" + some, withSharedCache()).code, 0);
  EXPECT_EQ(manifest("parts")["status"], "incomplete");
  ASSERT_EQ(call("run scene.toml --out parts --resume" + some, withSharedCache()).code, 0);
  EXPECT_EQ(manifest("parts")["incomplete"], manifest("some")["incomplete"]);
}

TEST_F(ShortDrive, AVehicleThatIsToStandIsComplete) {
  const Outcome run =
      call("run scene.toml --out stands --set driver.sprocket_speed=0 --set driver.drive_start=0", withSharedCache());
  EXPECT_EQ(run.code, 0) << run.errors;
  EXPECT_EQ(run.out.find("WARNING"), std::string::npos) << run.out;
  EXPECT_EQ(manifest("stands")["status"], "finished");
}

TEST_F(ShortDrive, IsMarkedInASweepAndNotRunAgain) {
  const std::string words = "sweep scene.toml --set driver.drive_start=0.01,0.05 --out s";
  const Outcome first = call(words, withSharedCache());
  ASSERT_EQ(first.code, 0) << first.errors;
  EXPECT_NE(first.out.find("WARNING: 2 of 2 runs are inconclusive"), std::string::npos) << first.out;
  const Csv csv(folder_ / "s" / "summary.csv");
  EXPECT_EQ(csv.at(0, "status"), "incomplete");
  EXPECT_NE(csv.at(0, "message").find("the vehicle never drove "), std::string::npos)
      << "less than 0.01 teeth: " << csv.at(0, "message");
  EXPECT_EQ(csv.at(0, "inconclusive"), "see message");
  EXPECT_NE(csv.at(1, "message").find("never drove"), std::string::npos) << csv.at(1, "message");
  EXPECT_GT(csv.number(1, "steps"), 0);
  const Outcome second = call(words, withSharedCache());
  EXPECT_NE((second.out + second.errors).find("already incomplete"), std::string::npos) << second.out << second.errors;
}

} // namespace
} // namespace grouser::commands
