// SPDX-License-Identifier: BSD-3-Clause
// A check with --of from the command line.
#include "runs/campaigns/sweeps/check_report.hpp"
#include "tests/runs/campaigns/sweeps/check_fixture.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace grouser::sweeps {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

class CheckOf : public test::Check {
protected:
  static constexpr const char* kWords = "check heap.toml --bar 45% --of ground_force_z ";

  /// Runs of a case in check.json.
  static std::size_t runsOf(const Json& check, const std::string& name) {
    for (const Json& c : check.at("cases"))
      if (c.at("name") == name) return c.at("runs").size();
    return 0;
  }
};

TEST_F(CheckOf, TheCheckStopsWhereTheBarIsMet) {
  writeHeap();
  const Outcome o = call(std::string(kWords) + "--out c");
  ASSERT_EQ(o.code, 0) << o.errors;
  const Json check = json("c/check.json"), goal = check.at("of").at(0), f = figure(check, "ground force z [N]");
  EXPECT_EQ(check.at("looks"), Json({3, 6, 12, 24}));
  EXPECT_EQ(goal.at("state"), "met");
  EXPECT_LE(goal.at("bar").get<double>(), 0.45 * std::fabs(f.at("value").get<double>()));
  EXPECT_EQ(goal.at("bar"), f.at("bar"));
  // The scatter of the heap far exceeds the effect of the step: seeds of the base come first.
  EXPECT_GT(runsOf(check, "base"), runsOf(check, "step_over_2"));
  EXPECT_EQ(runsOf(check, "step_over_2"), 3u);
  EXPECT_EQ(runsOf(check, "skin"), 0u);
  EXPECT_NE(o.out.find("  met\n"), std::string::npos) << o.out;
}

TEST_F(CheckOf, TheFilesAreTheSameForOneJobTwoJobsAndACheckThatGoesOn) {
  writeHeap();
  ASSERT_EQ(call(std::string(kWords) + "--out one").code, 0);
  ASSERT_EQ(call(std::string(kWords) + "--jobs 2 --out two").code, 0);
  const Outcome some = call(std::string(kWords) + "--out some --seconds 0.3");
  EXPECT_EQ(some.code, 0) << some.errors;
  EXPECT_NE(contents((folder_ / "one/check.json").string()), contents((folder_ / "some/check.json").string()));
  fs::remove(folder_ / "some/base,seed=1/manifest.json"); // a run that was lost
  ASSERT_EQ(call(std::string(kWords) + "--out some").code, 0);
  for (const char* name : {kCheckFile, kCheckSeries}) {
    const std::string text = contents((folder_ / "one" / name).string());
    ASSERT_FALSE(text.empty());
    EXPECT_EQ(text, contents((folder_ / "two" / name).string())) << name;
    EXPECT_EQ(text, contents((folder_ / "some" / name).string())) << name;
  }
}

TEST_F(CheckOf, AKilledCheckGoesOnWithTheSameLooks) {
  writeHeap();
  const std::string words = std::string(kWords) + "--budget 60s --set run.time_step=1e-5 --out c";
  // Killed after selecting its first runs.
  ASSERT_EQ(shell("\"$grouser\" " + words +
                  " & until test -e c/choice.json || ! kill -0 $!; do sleep 0.01; done; kill -KILL $!; wait $!")
                .code,
            137);
  const Json before = json("c/choice.json");
  const Outcome o = call(words);
  ASSERT_EQ(o.code, 0) << o.errors;
  const Json after = json("c/choice.json");
  ASSERT_FALSE(after.at("looks").empty());
  EXPECT_EQ(before.at("run_s"), after.at("run_s"));
  for (std::size_t look = 0; look < before.at("looks").size(); ++look)
    EXPECT_EQ(before.at("looks").at(look), after.at("looks").at(look));
  const std::string text = contents((folder_ / "c/check.json").string());
  ASSERT_EQ(call(words).code, 0);
  EXPECT_EQ(text, contents((folder_ / "c/check.json").string()));
}

TEST_F(CheckOf, ABarBeyondTheMostSeedsIsNamedWithWhatWouldDo) {
  writeHeap();
  const Outcome o = call("check heap.toml --bar 1% --of ground_force_z --seeds 3 --out c");
  ASSERT_EQ(o.code, 0) << o.errors;
  const Json goal = json("c/check.json").at("of").at(0);
  EXPECT_EQ(goal.at("state"), "not met: requires more than --seeds");
  EXPECT_NE(o.out.find("; largest contribution: seeds "), std::string::npos) << o.out;
  EXPECT_FALSE(goal.at("met").get<bool>());
}

TEST_F(CheckOf, WhereRunsRepeatAllFinerStepsAreRun) {
  writeFall();
  const std::string of = " --of grain.0.position.z_at_the_end --out ";
  ASSERT_EQ(call("check fall.toml --bar 5%" + of + "wide").code, 0);
  const Json wide = json("wide/check.json");
  EXPECT_EQ(wide.at("of").at(0).at("state"), "met");
  EXPECT_EQ(runsOf(wide, "step_over_8"), 1u);
  ASSERT_EQ(call("check fall.toml --bar 1e-9" + of + "narrow").code, 0);
  const Json narrow = json("narrow/check.json");
  EXPECT_EQ(narrow.at("of").at(0).at("met"), false);
  EXPECT_EQ(narrow.at("of").at(0).at("state"), "not met");
}

TEST_F(CheckOf, WrongWordsAreRefused) {
  writeHeap();
  for (const auto& [words, named] : {std::pair{"--of colour", "--of colour: unknown figure; choose from "},
                                     {"--bar 0% --of ground_force_z", "--bar"},
                                     {"--bar x% --of ground_force_z", "--bar"}}) {
    const Outcome o = call(std::string("check heap.toml --out c ") + words);
    EXPECT_EQ(o.code, 2) << words;
    EXPECT_EQ(o.error().find(named), 0u) << o.errors;
  }
  // Figures of a vehicle are known before any run.
  const Outcome o = call("check '" + std::string(GROUSER_SOURCE_DIR) + "/runs/scenes/ball_pit.toml' --of sinkag");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.error().find("choose from sinkage, torque, tension, "), std::string::npos) << o.errors;
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

} // namespace
} // namespace grouser::sweeps
