// SPDX-License-Identifier: BSD-3-Clause
// The studies of grains as a user calls them: help, tables, plots, and nothing overwritten.
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace grouser::studies {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

struct StudyCall {
  std::string name, options; ///< options that make it quick
  std::vector<std::string> files, words;
};

class StudyCommand : public ProgramTest, public testing::WithParamInterface<StudyCall> {};

TEST_P(StudyCommand, WritesItsTablesAndKeepsThem) {
  const StudyCall& study = GetParam();
  const Outcome all = call("study --help"), help = call("study " + study.name + " --help");
  EXPECT_EQ(all.code, 0);
  EXPECT_NE(all.out.find(study.name), std::string::npos) << all.out;
  EXPECT_EQ(help.code, 0);
  for (const char* option : {"--quick", "--out", "--force"})
    EXPECT_NE(help.out.find(option), std::string::npos) << option;

  const std::string words = "study " + study.name + " " + study.options + " --out results";
  const Outcome o = call(words);
  ASSERT_EQ(o.code, 0) << o.errors;
  for (const std::string& word : study.words) EXPECT_NE(o.out.find(word), std::string::npos) << word << "\n" << o.out;
  for (const std::string& file : study.files) {
    const fs::path path = folder_ / "results" / file;
    if (path.extension() == ".png" && o.errors.find("python3") != std::string::npos) continue; // no matplotlib here
    EXPECT_TRUE(fs::exists(path) && fs::file_size(path) > 100) << path << "\n" << o.errors;
  }
  const auto json = nlohmann::json::parse(contents(folder_ / "results" / "study.json"));
  EXPECT_EQ(json.at("study"), study.name);
  EXPECT_FALSE(json.at("commit").get<std::string>().empty());
  EXPECT_FALSE(json.at("machine").get<std::string>().empty());

  const Outcome again = call(words);
  EXPECT_EQ(again.code, 2) << "there are results in it";
  EXPECT_NE(again.errors.find("--force"), std::string::npos) << again.errors;
  EXPECT_EQ(call("study " + study.name + " --colour blue").code, 2);
}

class RandomStudy : public ProgramTest {};

TEST_F(RandomStudy, GoesOnWithTheTableThatAStoppedCallHasLeft) {
  const fs::path table = folder_ / "results" / "random.csv";
  ASSERT_EQ(call("study stability --random 1 --seed 3 --out results").code, 0);
  const std::string one = contents(table);
  const Outcome two = call("study stability --random 2 --seed 3 --resume --out results");
  ASSERT_EQ(two.code, 0) << two.errors;
  const std::string both = contents(table);
  EXPECT_EQ(both.substr(0, one.size()), one);
  EXPECT_EQ(std::count(both.begin(), both.end(), '\n'), 3);
  for (const char* word : {"longest step that does not blow up", "longest step without an alarm", "2 scenes"})
    EXPECT_NE(two.out.find(word), std::string::npos) << word << "\n" << two.out;
  const Outcome other = call("study stability --random 2 --seed 4 --resume --out results");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.errors.find("seed 3"), std::string::npos) << other.errors;
  EXPECT_EQ(call("study stability --seed 4").code, 2) << "of random scenes alone";
}

INSTANTIATE_TEST_SUITE_P(Grains, StudyCommand,
                         testing::Values(StudyCall{"impact",
                                                   "--quick --phases 4 --leaving 1 --collisions 20 --repeats 1",
                                                   {"impact.csv", "orders.csv", "cheapest.csv", "convergence.csv",
                                                    "speeds.csv", "impact.png"},
                                                   {"order of the worst error", "cheapest step", "published",
                                                    "linear clamped on a plane", "closed forms"}},
                                         StudyCall{"stability",
                                                   "--quick --grains 20 --column 3",
                                                   {"stability.csv", "limits.csv", "stability.png"},
                                                   {"predicted limit", "at 0.95 of the limit", "calm up to"}},
                                         StudyCall{"precision",
                                                   "--quick --grains 200 --configurations 2 --drift-grains 50 "
                                                   "--gas-time 0.05 --bed-time 0.05 --runs 2 --threads 1",
                                                   {"touch.csv", "drift.csv", "macroscopic.csv", "precision.png"},
                                                   {"float from the origin", "growth", "std. error"}}),
                         [](const auto& study) { return study.param.name; });

} // namespace
} // namespace grouser::studies
