// SPDX-License-Identifier: BSD-3-Clause
// Start order of the runs of a sweep, and their progress.
#include "runs/campaigns/sweeps/run_progress.hpp"
#include "runs/campaigns/sweeps/runner.hpp"
#include "runs/setup/grain_count.hpp"
#include "runs/setup/load_scene.hpp"
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>

namespace grouser::sweeps {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

/// Scenes of a grain that flies for up to 100 s, ended earlier by [stop]. None is run.
class SweepOrder : public ProgramTest {
protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::ofstream(scene()) << "version = 1\n[run]\nduration = 100\nthreads = 1\n[material.glass]\n[[grain]]\n"
                              "position = [0, 0, 1]\nradius = 0.01\nmaterial = \"glass\"\n";
  }
  fs::path scene() const { return folder_ / "fall.toml"; }
  /// Runs are a shell script with its folder in $2.
  SweepOptions options(const std::string& script) const {
    SweepOptions o;
    o.folder = folder_ / "out", o.program = folder_ / "program", o.plot = false;
    std::ofstream(o.program) << "#!/bin/sh\nwhile [ \"$1\" != --out ]; do shift; done\n" << script;
    fs::permissions(o.program, fs::perms::owner_all);
    return o;
  }
};

TEST(SweepProgress, IncompleteRunsHaveEndedAndAreNotFinished) {
  using output::RunStatus;
  const SweepOutcome finished{RunStatus::finished, ""}, incomplete{RunStatus::incomplete, "never drove"};
  EXPECT_EQ(endedText({finished, {RunStatus::failed, "x"}}), "1 of 2 runs finished");
  EXPECT_EQ(endedText({finished, finished}), "2 of 2 runs finished");
  EXPECT_EQ(endedText({finished, incomplete}), "2 of 2 runs ended, 1 incomplete");
}

TEST_F(SweepOrder, RunsWithTheMostWorkAreBegunFirstWhereSeveralGoAtATime) {
  SweepPlan plan = planSweep(scene(), {{"grain.0.velocity=[0,0,1],[0,0,2],[0,0,3],[0,0,4]"}});
  const double ends[] = {5, 20, 5, 8};
  for (std::size_t i = 0; i < 4; ++i) plan.runs[i].expectedEnd = ends[i];
  const fs::path begun = folder_ / "begun";
  SweepOptions o = options("basename \"$2\" >> " + begun.string() + "\nsleep 0.5\n");
  const auto order = [&](int jobs, double seconds) {
    fs::remove(begun);
    o.jobs = jobs, o.seconds = seconds;
    runMissing(plan, o, "sweep", [](const std::vector<SweepOutcome>&) {});
    std::ifstream file(begun);
    std::string names;
    for (std::string line; std::getline(file, line);)
      for (std::size_t i = 0; i < 4; ++i)
        if (line == plan.runs[i].name) names += std::to_string(i);
    return names;
  };
  // Two at a time: either of a pair may write first.
  const auto inPairs = [&](double seconds) {
    std::string names = order(2, seconds);
    EXPECT_EQ(names.size(), 4U);
    for (std::size_t i = 0; i + 1 < names.size(); i += 2)
      if (names[i] > names[i + 1]) std::swap(names[i], names[i + 1]);
    return names;
  };
  EXPECT_EQ(order(1, 0), "0123");
  EXPECT_EQ(inPairs(1000), "0123") << "the last may end early";
  EXPECT_EQ(inPairs(0), "1302");
}

TEST_F(SweepOrder, AVehicleAndGrainsAreWorkAndSoIsTime) {
  SweepPlan plan = planSweep(scene(), {{"grain.0.velocity=[0,0,1],[0,0,2]"}});
  EXPECT_EQ(workOf(plan.runs[0]), 100) << "one grain, 100 s";
  plan.runs[0].expectedEnd = 8;
  EXPECT_EQ(workOf(plan.runs[0]), 8);
  plan.runs[1].scene = setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/runs/scenes/soil_coarse.toml");
  plan.runs[1].expectedEnd = 2;
  EXPECT_EQ(workOf(plan.runs[1]), 2 * (20000.0 + static_cast<double>(setup::plannedGrains(plan.runs[1].scene))));
}

TEST_F(SweepOrder, ShareDoneIsOfTheTimeAtWhichRunsAreExpectedToEnd) {
  SweepPlan plan = planSweep(scene(), {{"grain.0.velocity=[0,0,1],[0,0,2]"}});
  EXPECT_EQ(expectedEnd(plan.runs[0]), 100);
  plan.runs[0].expectedEnd = 8, plan.runs[1].expectedEnd = 2;
  EXPECT_EQ(expectedEnd(plan.runs[0]), 8);
  plan.runs[1].expectedEnd = 200;
  EXPECT_EQ(expectedEnd(plan.runs[1]), 100) << "it runs for its full duration";
  plan.runs[1].expectedEnd = 2;
  // A program that simulates 5 s at once and then waits until after the first progress line.
  SweepOptions o = options("printf 'step,time [s]\\n100,2\\n250,5\\n260,5.2' > \"$2/timeseries.csv\"\nsleep 5.3\n");
  o.jobs = 2;
  ::testing::internal::CaptureStderr();
  runMissing(plan, o, "sweep", [](const std::vector<SweepOutcome>&) {});
  const std::string said = ::testing::internal::GetCapturedStderr();
  // First run: 5 s of 8 s; second: at most the expected 2 s. The last line is incomplete.
  EXPECT_NE(said.find("sweep:  70.0 %"), std::string::npos) << said;
  EXPECT_EQ(timeReached(folder_), 0);
  std::ofstream(folder_ / "timeseries.csv") << "step,time [s]\n";
  EXPECT_EQ(timeReached(folder_), 0);
}

TEST(RunTimes, AKindWithoutARunHasNoTime) {
  RunTimes times;
  const std::size_t rigid = times.add("rigid", "", 10), soil = times.add("scm", "", 1000),
                    bed = times.add("bed", "", 50);
  EXPECT_FALSE(times.left(1)) << "nothing has run";
  times.begin(rigid, 0);
  times.reach(rigid, 0, 5);
  EXPECT_FALSE(times.left(1)) << "it still prepares";
  times.end(rigid, 1, 0, 4);
  EXPECT_FALSE(times.left(1)) << "rigid ground says nothing about soil and grains";
  times.begin(soil, 0);
  times.end(soil, 1, 0, 2);
  times.begin(bed, 0);
  // Rows from 30 s on, 1 % of the run per second.
  for (int k = 1; k <= 10; ++k) times.reach(bed, 0.01 * k, 30 + k);
  ASSERT_TRUE(times.left(1));
  EXPECT_NEAR(*times.left(1), 90, 1e-9);
  times.reach(bed, 0.1, 45);
  EXPECT_NEAR(*times.left(1), 85, 1e-9) << "it counts down between rows";
}

TEST(RunTimes, OfOneKindFollowWorkPreparationAndJobs) {
  RunTimes times;
  const std::size_t first = times.add("bed", "seed 1", 100), second = times.add("bed", "seed 1", 200),
                    third = times.add("bed", "seed 2", 100);
  times.begin(first, 0);
  times.end(first, 31, 30, 10); // 30 of 31 s settle the bed; 0.1 s per unit of work
  EXPECT_NEAR(*times.left(1), (1 + 20) + (31 + 10), 1e-9) << "the second shares the bed of the first";
  EXPECT_NEAR(*times.left(2), 41, 1e-9) << "no less than the longest run";
  times.begin(second, 0);
  times.reach(second, 0, 0.5);
  EXPECT_NEAR(*times.left(1), (0.5 + 20) + 41, 1e-9);
  times.end(second, 1, 0, 20), times.begin(third, 0.5);
  EXPECT_NEAR(*times.left(1), 16 + 5, 1e-9) << "resumed at half; mean preparation";
}

} // namespace
} // namespace grouser::sweeps
