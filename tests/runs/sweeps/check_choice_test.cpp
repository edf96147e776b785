// SPDX-License-Identifier: BSD-3-Clause
#include "runs/sweeps/check_choice.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace grouser::sweeps {
namespace {

/// Base, half step (2 runs of the base), skin, depth (1.5), and one that is refused.
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

TEST(CheckChoice, WithoutABudgetEveryCaseHasAllSeeds) {
  const CheckChoice c = chooseRuns(someCases(true), 8, std::nullopt, 10, 1);
  EXPECT_EQ(c.seeds, (Counts{8, 8, 1, 8, 0}));
  EXPECT_DOUBLE_EQ(c.seconds, 10 * (8 + 16 + 1 + 12));
  EXPECT_EQ(chooseRuns(someCases(false), 8, std::nullopt, 10, 1).seeds, (Counts{1, 1, 1, 1, 0}));
}

TEST(CheckChoice, ABudgetTakesCasesInOrderThenSeeds) {
  // Three seeds of the base, three of the half step, the skin: 3 + 6 + 1 runs; the depth's 4.5 do not fit into 12.
  const CheckChoice few = chooseRuns(someCases(true), 8, 120, 10, 1);
  EXPECT_EQ(few.seeds, (Counts{3, 3, 1, 0, 0}));
  EXPECT_EQ(few.beyondBudget, std::vector<std::size_t>{3});
  EXPECT_DOUBLE_EQ(few.seconds, 100);
  // What is too long is left out; what comes later and is shorter may still fit.
  EXPECT_EQ(chooseRuns(someCases(true), 8, 85, 10, 1).seeds, (Counts{3, 0, 1, 3, 0}));
  // All cases with three seeds take 14.5, each more seed 4.5: with 24 there are five.
  EXPECT_EQ(chooseRuns(someCases(true), 8, 240, 10, 1).seeds, (Counts{5, 5, 1, 5, 0}));
  EXPECT_EQ(chooseRuns(someCases(true), 4, 2400, 10, 1).seeds, (Counts{4, 4, 1, 4, 0}));
}

TEST(CheckChoice, TwoJobsDoTwiceAsMuch) {
  EXPECT_EQ(chooseRuns(someCases(true), 8, 120, 10, 2).seeds, chooseRuns(someCases(true), 8, 240, 10, 1).seeds);
  EXPECT_DOUBLE_EQ(chooseRuns(someCases(true), 8, 120, 10, 2).seconds, 10 * (5 + 10 + 1 + 7.5) / 2);
}

TEST(CheckChoice, TheBaseIsAlwaysRun) {
  EXPECT_EQ(chooseRuns(someCases(true), 8, 1, 10, 1).seeds, (Counts{3, 0, 0, 0, 0}));
}

TEST(CheckChoice, BudgetsHaveUnits) {
  EXPECT_DOUBLE_EQ(budgetSeconds("90"), 90);
  EXPECT_DOUBLE_EQ(budgetSeconds("90s"), 90);
  EXPECT_DOUBLE_EQ(budgetSeconds("20min"), 1200);
  EXPECT_DOUBLE_EQ(budgetSeconds("1.5h"), 5400);
  for (const char* wrong : {"", "min", "20 minutes", "-5min", "0", "0.5s", "nan", "inf", "1e400"})
    EXPECT_THROW(budgetSeconds(wrong), base::InputError) << wrong;
}

} // namespace
} // namespace grouser::sweeps
