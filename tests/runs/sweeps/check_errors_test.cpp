// SPDX-License-Identifier: BSD-3-Clause
#include "runs/sweeps/check_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
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
  // Errors of either sign below C h: nothing tells an order, and the bar reaches beyond the error at h.
  const std::vector<double> values = {3 + 0.2, 3 - 0.09, 3 + 0.04, 3 - 0.01};
  const StepError e = stepError(values);
  EXPECT_FALSE(e.order);
  EXPECT_GE(e.bar, 0.2);
  EXPECT_LE(e.bar, 0.35);
  // Two values, or three, show none; a bar there is all the same, of two values twice the change.
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

TEST(CheckErrors, OfSeedsAnOrderIsSeenOnlyWhereBothIntervalsLeaveOutZero) {
  const ScatteredStepError first = scatteredStepError({-0.1, 0.01}, support::Estimate{-0.2, 0.02});
  ASSERT_TRUE(first.order);
  EXPECT_NEAR(*first.order, 1, 1e-12);
  EXPECT_NEAR(first.change.value, -0.2, 1e-12);
  EXPECT_NEAR(first.change.halfWidth, 0.02, 1e-12);
  EXPECT_FALSE(scatteredStepError({-0.1, 0.11}, support::Estimate{-0.2, 0.02}).order);
  EXPECT_FALSE(scatteredStepError({-0.1, 0.01}, support::Estimate{-0.2, 0.21}).order);
  EXPECT_FALSE(scatteredStepError({-0.1, 0.01}, support::Estimate{0.2, 0.02}).order); // other signs
  EXPECT_FALSE(scatteredStepError({-0.1, 0.01}, std::nullopt).order);
  EXPECT_NEAR(scatteredStepError({-0.1, 0.11}, std::nullopt).change.value, -0.1, 1e-12);
}

TEST(CheckErrors, FewSeedsShowNothingUnlessTheyScatterLittle) {
  EXPECT_EQ(judgeSeeds({0.0, 0.04}, 0.05, 8), studies::Verdict::equal);
  EXPECT_EQ(judgeSeeds({0.0, 0.04}, 0.05, 7), studies::Verdict::notShown);
  EXPECT_EQ(judgeSeeds({0.0, 0.02}, 0.05, 3), studies::Verdict::equal);
  EXPECT_EQ(judgeSeeds({0.2, 0.02}, 0.05, 3), studies::Verdict::differs);
  EXPECT_EQ(judgeSeeds({0.0, 0.06}, 0.05, 20), studies::Verdict::notShown);
}

TEST(CheckErrors, TheBarAddsSquaresOfChangesWithTheirIntervals) {
  const std::vector<support::Estimate> errors = {{-3, 1}, {0, 3}};
  EXPECT_NEAR(totalBar(12, errors), 13, 1e-12); // 12, 4 and 3
  EXPECT_TRUE(std::isinf(totalBar(INFINITY, errors)));
}

TEST(CheckErrors, SeedsForABarFollowStudentsDistribution) {
  // Deviation 1 of 4 seeds: half width 3.182 / 2. Of n seeds it is t(n - 1) / sqrt(n): 0.754 at 9, 0.715 at 10.
  const double half = 3.1824463 / 2;
  EXPECT_EQ(seedsFor(0.76, half, 4), 10);
  EXPECT_EQ(seedsFor(0.77, half, 4), 9);
  EXPECT_EQ(seedsFor(half * 1.0001, half, 4), 4);
  EXPECT_EQ(seedsFor(1e-6, half, 4), 0);
  EXPECT_EQ(seedsFor(0.1, INFINITY, 1), 0);
}

} // namespace
} // namespace grouser::sweeps
