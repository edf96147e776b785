// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check_choice.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace grouser::sweeps {
namespace {

/// Base, half step (2 runs of the base), skin, depth (1.5), and one rejected case.
CheckCases someCases(bool seeded) {
  CheckCases all;
  all.seeded = seeded;
  const auto add = [&](CheckAxis axis, double cost, const std::string& refused = "") {
    CheckCase c;
    c.axis = axis, c.cost = cost, c.refused = refused;
    all.cases.push_back(c);
  };
  add(CheckAxis::base, 1), add(CheckAxis::step, 2), add(CheckAxis::skin, 1), add(CheckAxis::depth, 1.5);
  add(CheckAxis::width, 1, "too wide");
  return all;
}

using Counts = std::vector<int>;

/// Without settling: a base run takes 10 s.
RunCosts byStepsAlone() {
  RunCosts costs;
  costs.run = 10;
  return costs;
}

/// A base run takes 10 s after 90 s of settling; the skin case shares its bed.
RunCosts withBeds() {
  RunCosts costs = byStepsAlone();
  costs.settling = 90, costs.beds = {0, 1, 0, 3, 4};
  return costs;
}

TEST(CheckChoice, WithoutABudgetEveryCaseHasAllSeeds) {
  const CheckChoice c = chooseRuns(someCases(true), 8, std::nullopt, byStepsAlone(), 1);
  EXPECT_EQ(c.seeds, (Counts{8, 8, 1, 8, 0}));
  EXPECT_DOUBLE_EQ(c.seconds, 10 * (8 + 16 + 1 + 12));
  EXPECT_EQ(chooseRuns(someCases(false), 8, std::nullopt, byStepsAlone(), 1).seeds, (Counts{1, 1, 1, 1, 0}));
}

TEST(CheckChoice, ABudgetTakesCasesInOrderThenSeeds) {
  // Three seeds of the base, three of the half step, the skin: 3 + 6 + 1 runs; the depth's 4.5 exceed 12.
  const CheckChoice few = chooseRuns(someCases(true), 8, 120, byStepsAlone(), 1);
  EXPECT_EQ(few.seeds, (Counts{3, 3, 1, 0, 0}));
  EXPECT_EQ(few.beyondBudget, std::vector<std::size_t>{3});
  EXPECT_DOUBLE_EQ(few.seconds, 100);
  // A case that is too long is skipped; a later, shorter one may still fit.
  EXPECT_EQ(chooseRuns(someCases(true), 8, 85, byStepsAlone(), 1).seeds, (Counts{3, 0, 1, 3, 0}));
  // All cases with three seeds take 14.5, each further seed 4.5: 24 allows five.
  EXPECT_EQ(chooseRuns(someCases(true), 8, 240, byStepsAlone(), 1).seeds, (Counts{5, 5, 1, 5, 0}));
  EXPECT_EQ(chooseRuns(someCases(true), 4, 2400, byStepsAlone(), 1).seeds, (Counts{4, 4, 1, 4, 0}));
}

TEST(CheckChoice, TwoJobsDoTwiceAsMuch) {
  EXPECT_EQ(chooseRuns(someCases(true), 8, 120, byStepsAlone(), 2).seeds,
            chooseRuns(someCases(true), 8, 240, byStepsAlone(), 1).seeds);
  EXPECT_DOUBLE_EQ(chooseRuns(someCases(true), 8, 120, byStepsAlone(), 2).seconds, 10 * (5 + 10 + 1 + 7.5) / 2);
}

TEST(CheckChoice, EveryRunSettlesItsBedUnlessThatIsThereAlready) {
  // Two seeds: base and half step 2 x (10 + 90) and 2 x (20 + 90) s, the skin 10 s on the base's bed, depth 2 x (15 +
  // 90).
  EXPECT_DOUBLE_EQ(chooseRuns(someCases(true), 2, std::nullopt, withBeds(), 1).seconds, 200 + 220 + 10 + 210);
  // If each settles its own bed, so does the skin.
  RunCosts alone = withBeds();
  alone.beds.clear();
  EXPECT_DOUBLE_EQ(chooseRuns(someCases(true), 2, std::nullopt, alone, 1).seconds, 200 + 220 + 100 + 210);
  // Cached: both beds of the base, the second of the half step. Other settling times count.
  RunCosts kept = withBeds();
  kept.isKept = [](int bed, int seed) { return bed == 0 || (bed == 1 && seed == 1); };
  EXPECT_DOUBLE_EQ(chooseRuns(someCases(true), 2, std::nullopt, kept, 1).seconds, 20 + 130 + 10 + 210);
  EXPECT_EQ(chooseRuns(someCases(true), 2, 160, kept, 1).seeds, (Counts{2, 2, 1, 0, 0}));
  CheckCases deeper = someCases(true);
  deeper.cases[3].settling = 2;
  EXPECT_DOUBLE_EQ(chooseRuns(deeper, 2, std::nullopt, kept, 1).seconds, 20 + 130 + 10 + 30 + 360);
}

TEST(CheckChoice, MoreSeedsSettleMoreBeds) {
  // Three seeds of base and skin take 3 x 100 + 10 s, one more 100 s; the other cases are rejected.
  CheckCases cases = someCases(true);
  cases.cases[1].refused = cases.cases[3].refused = "no";
  EXPECT_EQ(chooseRuns(cases, 8, 411, withBeds(), 1).seeds, (Counts{4, 0, 1, 0, 0}));
  EXPECT_EQ(chooseRuns(cases, 8, 409, withBeds(), 1).seeds, (Counts{3, 0, 1, 0, 0}));
}

TEST(CheckChoice, IsKeptAsItWas) {
  const CheckCases cases = someCases(true);
  const CheckChoice choice = chooseRuns(cases, 8, 120, byStepsAlone(), 1);
  EXPECT_EQ(keptChoice(choiceJson(choice), cases, 8), choice);
  nlohmann::json other = choiceJson(choice);
  other["seeds"].push_back(1);
  EXPECT_FALSE(keptChoice(other, cases, 8));
  other = choiceJson(choice), other["seeds"][0] = 2'000'000'000;
  EXPECT_FALSE(keptChoice(other, cases, 8));
  other = choiceJson(choice), other["left_out"] = {7};
  EXPECT_FALSE(keptChoice(other, cases, 8));
  EXPECT_FALSE(keptChoice(nlohmann::json(), cases, 8));
  EXPECT_FALSE(keptChoice(nlohmann::json{{"seeds", "some"}}, cases, 8));
}

TEST(CheckChoice, TheBaseIsAlwaysRun) {
  EXPECT_EQ(chooseRuns(someCases(true), 8, 1, byStepsAlone(), 1).seeds, (Counts{3, 0, 0, 0, 0}));
}

TEST(CheckChoice, BudgetsHaveUnits) {
  EXPECT_DOUBLE_EQ(budgetSeconds("90"), 90);
  EXPECT_DOUBLE_EQ(budgetSeconds("90s"), 90);
  EXPECT_DOUBLE_EQ(budgetSeconds("20min"), 1200);
  EXPECT_DOUBLE_EQ(budgetSeconds("1.5h"), 5400);
  for (const char* wrong :
       {"", "min", "20 minutes", "-5min", "0", "0.5s", "nan", "inf", "1e400", "0x10s", " 90s", "1e300h"})
    EXPECT_THROW(budgetSeconds(wrong), base::InputError) << wrong;
}

} // namespace
} // namespace grouser::sweeps
