// SPDX-License-Identifier: BSD-3-Clause
// Cost of features: zero if they are off. No test depends on times.
#include "runs/validation/studies/features.hpp"
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace grouser::studies {

using namespace test; // fixtures

namespace {

FeaturesCommand quick() {
  FeaturesCommand c;
  c.grains = 864, c.pairs = 2, c.turn = 1e-3;
  return c;
}

const Feature& feature(const std::string& name) {
  return *std::find_if(features().begin(), features().end(), [&](const Feature& f) { return f.name == name; });
}

FeatureCost cost(const std::string& name) { return costOf(measureFeature(quick(), feature(name), base::cpuExec(1))); }

TEST(FeatureCosts, WhatIsOffHasTheSameStateAndMemory) {
  int neutral = 0;
  for (const Feature& f : features()) {
    if (!f.neutral) continue;
    ++neutral;
    const FeatureCost c = cost(f.name);
    EXPECT_TRUE(c.sameState) << f.name;
    EXPECT_EQ(c.bytesWith, c.bytesWithout) << f.name;
  }
  EXPECT_GE(neutral, 4);
}

TEST(FeatureCosts, WhatIsOnTakesMemoryAndChangesTheState) {
  for (const char* name : {"friction", "rolling"}) {
    const FeatureCost c = cost(name);
    EXPECT_FALSE(c.sameState) << name;
    EXPECT_GT(c.bytesWith, c.bytesWithout) << name;
  }
  EXPECT_GT(cost("radii").bytesWith, cost("radii").bytesWithout);
  EXPECT_TRUE(cost("no_ledger").sameState) << "energy accounting does not change the motion";
}

jobs::Table pairs(const std::vector<std::vector<double>>& times, double bytesWith, double same) {
  jobs::Table table{kFeatureColumns, {}};
  for (const auto& t : times) table.rows.push_back({t[0], t[1], 100, bytesWith, 864, 864, same});
  return table;
}

TEST(FeatureCosts, DifferenceIsThatOfThePairs) {
  // Both drift alike; the pair differences are about 10.
  const FeatureCost c = costOf(pairs({{100, 110}, {200, 211}, {300, 309}}, 120, 0));
  EXPECT_DOUBLE_EQ(c.without, 200);
  EXPECT_NEAR(c.difference.value, 10, 1e-12);
  // Student's 4.303 for two degrees of freedom, deviation 1, three pairs.
  EXPECT_NEAR(c.difference.halfWidth, 4.3027 / std::sqrt(3.0), 1e-3);
  EXPECT_NEAR(c.relative.value, 0.05, 1e-12);
  EXPECT_EQ(c.bytesWith - c.bytesWithout, 20);
}

TEST(FeatureCosts, NothingMeansStateMemoryAndTime) {
  const std::vector<std::vector<double>> alike = {{100, 101}, {100, 99}, {100, 100}},
                                         dearer = {{100, 110}, {100, 111}, {100, 109}};
  EXPECT_TRUE(costOf(pairs(alike, 100, 1)).isNothing());
  EXPECT_FALSE(costOf(pairs(alike, 100, 0)).isNothing());
  EXPECT_FALSE(costOf(pairs(alike, 101, 1)).isNothing());
  EXPECT_FALSE(costOf(pairs(dearer, 100, 1)).isNothing());
}

class FeaturesStudy : public ProgramTest {};

TEST_F(FeaturesStudy, GoesOnWithWhatIsThereAndKnowsItsFeatures) {
  const std::string words = "study features --quick --pairs 2 --threads 1 --out results --features ";
  const Outcome one = call(words + "rolling");
  ASSERT_EQ(one.code, 0) << one.errors;
  EXPECT_NE(one.out.find("rolling_friction = 0.1"), std::string::npos) << one.out;
  const Outcome two = call(words + "rolling,off_rolling --resume");
  EXPECT_EQ(two.code, 0) << two.errors;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "results/runs/off_rolling.csv"));
  const Outcome none = call(words + "colour --force");
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.error().find("--features colour: unknown feature; choose from friction, rolling"), std::string::npos)
      << none.errors;
}

TEST_F(FeaturesStudy, OfRanksBothEndInTheSameState) {
  const Outcome one = call("study features --quick --pairs 2 --turn 0.01 --out results --features ranks");
  ASSERT_EQ(one.code, 0) << one.errors;
  std::ifstream rows(folder_ / "results/runs/ranks.csv");
  std::string line;
  std::getline(rows, line);
  EXPECT_EQ(line.substr(line.rfind(',') + 1), "same state");
  int pairs = 0;
  for (; std::getline(rows, line); ++pairs) EXPECT_EQ(line.substr(line.rfind(',') + 1), "1") << line;
  EXPECT_EQ(pairs, 2);
  const Outcome none = call("study features --pairs 2 --out other --features ranks", "PATH=/nowhere ");
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.error().find("mpirun cannot be started"), std::string::npos) << none.errors;
}

} // namespace
} // namespace grouser::studies
