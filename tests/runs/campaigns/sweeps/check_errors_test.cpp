// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace grouser::sweeps {
namespace {

/// exact + c h^p at h = 1, 1/2, 1/4, 1/8.
std::vector<double> converging(double exact, double c, double order, int count = 4) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(exact + c * std::exp2(-order * i));
  return values;
}

TEST(CheckErrors, OfAPowerOfTheStepTheOrderIsSeenAndTheLimitFound) {
  for (const double order : {0.6, 1.0, 2.0, 4.0}) {
    const StepError e = stepError(converging(3, 0.2, order));
    ASSERT_TRUE(e.order) << order;
    EXPECT_NEAR(*e.order, order, 1e-9);
    EXPECT_NEAR(e.change, -0.2, 1e-9);
    EXPECT_NEAR(e.bar, 1.25 * 0.2, 1e-9); // Roache's factor
  }
}

TEST(CheckErrors, NoOrderIsAssumed) {
  // Errors of either sign below C h: no observed order, and the bar exceeds the error at h.
  const std::vector<double> values = {3 + 0.2, 3 - 0.09, 3 + 0.04, 3 - 0.01};
  const StepError e = stepError(values);
  EXPECT_FALSE(e.order);
  EXPECT_GE(e.bar, 0.2);
  EXPECT_LE(e.bar, 0.35);
  // Two or three values have no observed order, but a bar; for two values it is twice the change.
  EXPECT_FALSE(stepError(converging(3, 0.2, 1, 3)).order);
  EXPECT_NEAR(stepError(converging(3, 0.2, 1, 2)).bar, 0.2, 1e-12);
  EXPECT_TRUE(std::isinf(stepError(std::vector<double>{3.0}).bar));
}

TEST(CheckErrors, WithoutAnOrderTheBarStillHoldsWhatFallsInProportionToTheStep) {
  for (const double order : {1.0, 1.5, 2.0, 3.0}) {
    const std::vector<double> three = converging(1, 0.1, order, 3);
    EXPECT_GE(stepError(three).bar, 0.1 * (1 - 1e-12)) << order;
  }
}

TEST(CheckErrors, WhatDoesNotChangeHasNoError) {
  const StepError e = stepError(std::vector<double>{2, 2, 2, 2});
  EXPECT_EQ(e.bar, 0);
  EXPECT_FALSE(e.order);
}

using Numbers = std::vector<double>;

TEST(CheckErrors, OfSeedsAnOrderIsSeenOnlyWhereBothIntervalsLeaveOutZero) {
  const Numbers fine = {-0.11, -0.10, -0.09}, coarse = {-0.22, -0.20, -0.18}, wide = {-0.3, -0.1, 0.1};
  const ScatteredStepError first = scatteredStepError(fine, coarse);
  ASSERT_TRUE(first.order);
  EXPECT_NEAR(*first.order, 1, 1e-12);
  EXPECT_NEAR(first.change.value, -0.2, 1e-12);
  // 4 f - c for each seed: -0.22, -0.20, -0.18.
  EXPECT_NEAR(first.change.halfWidth, 4.303 * 0.02 / std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(first.bar, 0.2 + first.change.halfWidth, 1e-12);
  EXPECT_FALSE(scatteredStepError(wide, coarse).order);
  EXPECT_FALSE(scatteredStepError(fine, wide).order);
  EXPECT_FALSE(scatteredStepError(fine, Numbers{0.22, 0.20, 0.18}).order); // other signs
  // No order is assumed, only that the error at h/2 equals its difference from h.
  const ScatteredStepError none = scatteredStepError(fine, {});
  EXPECT_FALSE(none.order);
  EXPECT_NEAR(none.change.value, -0.1, 1e-12);
  EXPECT_NEAR(none.bar, 2 * (0.1 + none.change.halfWidth), 1e-12);
}

TEST(CheckErrors, TheBarOfScatteredRunsHoldsAnErrorOfFirstOrder) {
  // Eight seeds, each run with its own noise; the error at h is C = 1, so the mean changes are -1/2 and -1.
  std::mt19937 dice(1);
  for (const double noise : {0.05, 0.1, 0.2, 0.5, 2.0})
    for (const bool withCoarse : {true, false}) {
      std::normal_distribution<double> scatter(0, noise);
      constexpr int kTrials = 1000;
      int held = 0;
      for (int trial = 0; trial < kTrials; ++trial) {
        Numbers fine, coarse;
        for (int seed = 0; seed < 8; ++seed) {
          const double half = 0.5 + scatter(dice), base = 1 + scatter(dice), twice = 2 + scatter(dice);
          fine.push_back(half - base);
          if (withCoarse) coarse.push_back(base - twice);
        }
        held += scatteredStepError(fine, coarse).bar >= 1 ? 1 : 0;
      }
      EXPECT_GE(held, 0.9 * kTrials) << noise << (withCoarse ? " with 2 h" : "");
    }
}

TEST(CheckErrors, FewSeedsShowNothingEqualUnlessTheyScatterLittle) {
  EXPECT_EQ(judgeSeeds({0.0, 0.04}, 0.05, 8), jobs::Verdict::equal);
  EXPECT_EQ(judgeSeeds({0.0, 0.04}, 0.05, 7), jobs::Verdict::inconclusive);
  EXPECT_EQ(judgeSeeds({0.0, 0.02}, 0.05, 3), jobs::Verdict::equal);
  EXPECT_EQ(judgeSeeds({0.2, 0.1}, 0.05, 3), jobs::Verdict::differs);
  EXPECT_EQ(judgeSeeds({0.0, 0.06}, 0.05, 20), jobs::Verdict::inconclusive);
}

TEST(CheckErrors, TheBarIsTheRootOfTheSumOfSquares) {
  EXPECT_NEAR(totalBar(12, Numbers{4, 3}), 13, 1e-12);
  EXPECT_TRUE(std::isinf(totalBar(INFINITY, Numbers{4, 3})));
}

TEST(CheckErrors, SeedsForABarFollowStudentsDistribution) {
  // Deviation 1 of 4 seeds: half width 3.182 / 2. For n seeds it is t(n - 1) / sqrt(n): 0.754 at 9, 0.715 at 10.
  const double half = 3.1824463 / 2;
  EXPECT_EQ(seedsFor(0.76, half, 4), 10);
  EXPECT_EQ(seedsFor(0.77, half, 4), 9);
  EXPECT_EQ(seedsFor(half * 1.0001, half, 4), 4);
  EXPECT_EQ(seedsFor(1e-6, half, 4), 0);
  EXPECT_EQ(seedsFor(0.1, INFINITY, 1), 0);
}

} // namespace
} // namespace grouser::sweeps
