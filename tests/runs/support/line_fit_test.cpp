// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/line_fit.hpp"

#include "base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace grouser::support {
namespace {

TEST(LineFit, IsThatOfAPower) {
  std::vector<double> x, y;
  for (int k = 1; k <= 5; ++k) x.push_back(k), y.push_back(3.0 * k * k);
  const LineFit exact = fitPower(x, y);
  EXPECT_NEAR(exact.slope, 2, 1e-12);
  EXPECT_NEAR(exact.intercept, std::log(3.0), 1e-12);
  EXPECT_NEAR(exact.slopeEstimate().halfWidth, 0, 1e-6);
  EXPECT_EQ(fitPower(std::vector{1.0, 0.0, -1.0, 2.0}, std::vector{1.0, 5.0, 5.0, 2.0}).points, 2) << "no logarithm";
}

TEST(LineFit, CovarianceByHand) {
  // Mean 3 and 3, sum of squares of x 10: slope 8 / 10, sum of squared residuals 3.6; t(3) = 3.182.
  const LineFit fit = fitLine(std::vector{1.0, 2.0, 3.0, 4.0, 5.0}, std::vector{2.0, 1.0, 3.0, 5.0, 4.0});
  EXPECT_NEAR(fit.slope, 0.8, 1e-12);
  EXPECT_NEAR(fit.intercept, 0.6, 1e-12);
  EXPECT_NEAR(fit.slopeVariance, 1.2 / 10, 1e-12) << "s^2 / sum of squares";
  EXPECT_NEAR(fit.interceptVariance, 1.2 * (1.0 / 5 + 9.0 / 10), 1e-12);
  EXPECT_NEAR(fit.covariance, -1.2 * 3 / 10, 1e-12);
  EXPECT_NEAR(fit.slopeEstimate().halfWidth, 3.182 * std::sqrt(0.12), 1e-12);
  EXPECT_NEAR(fit.interceptEstimate().halfWidth, 3.182 * std::sqrt(1.32), 1e-12);
  EXPECT_NEAR(fit.at(3).halfWidth, 3.182 * std::sqrt(1.2 / 5), 1e-12) << "smallest at the mean";
  EXPECT_NEAR(fit.at(3).value, 3, 1e-12);
  EXPECT_EQ(fit.slopeText(), "0.80 +- 1.10");
}

TEST(LineFit, FarFromTheOriginItLosesNoDigits) {
  // The normal equations would fail: (1e7)^2 leaves nothing of 1.
  const LineFit fit = fitLine(std::vector{1e7, 1e7 + 1, 1e7 + 2}, std::vector{4.0, 6.0, 8.0});
  EXPECT_NEAR(fit.slope, 2, 1e-7);
}

TEST(LineFit, WhereThereIsNoLine) {
  EXPECT_EQ(fitLine(std::vector{1.0}, std::vector{1.0}).points, 0);
  EXPECT_EQ(fitLine(std::vector{2.0, 2.0, 2.0}, std::vector{1.0, 2.0, 3.0}).points, 0) << "all x are equal";
  const LineFit two = fitLine(std::vector{1.0, 2.0}, std::vector{1.0, 3.0});
  EXPECT_NEAR(two.slope, 2, 1e-12);
  EXPECT_FALSE(two.hasError());
  EXPECT_EQ(two.slopeText(), "-");
}

TEST(LineFit, StudentsQuantilesAreThoseOfTheTables) {
  // M. Abramowitz and I. Stegun, Handbook of Mathematical Functions (1964), table 26.10, and tan of the first.
  EXPECT_NEAR(student(1, 0.01), 63.657, 5e-4);
  EXPECT_NEAR(student(2, 0.01), 9.925, 5e-4);
  EXPECT_NEAR(student(3, 0.02), 4.541, 5e-4);
  EXPECT_NEAR(student(5, 0.01), 4.032, 5e-4);
  EXPECT_NEAR(student(11, 0.02), 2.718, 5e-4);
  EXPECT_NEAR(student(24, 0.01), 2.797, 5e-4);
  EXPECT_NEAR(student(120, 0.1), 1.658, 5e-4);
  for (const int freedom : {1, 2, 7, 16}) EXPECT_NEAR(student(freedom, 0.05 + 1e-12), student95(freedom), 1e-3);
}

TEST(LineFit, IntervalsHoldTheTruthNineteenTimesOfTwenty) {
  int slopes = 0, intercepts = 0;
  constexpr int kTrials = 2000;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    std::vector<double> x, y;
    for (std::uint64_t k = 0; k < 6; ++k) {
      const double u = base::uniform(1, 0, trial, 2 * k), v = base::uniform(1, 0, trial, 2 * k + 1);
      const double gauss = std::sqrt(-2 * std::log(1 - u)) * std::cos(2 * std::numbers::pi * v);
      x.push_back(static_cast<double>(k)), y.push_back(1 + 0.5 * x.back() + gauss);
    }
    const LineFit fit = fitLine(x, y);
    slopes += std::fabs(fit.slope - 0.5) < fit.slopeEstimate().halfWidth;
    intercepts += std::fabs(fit.intercept - 1) < fit.interceptEstimate().halfWidth;
  }
  // Binomial of 2000 with 0.95: standard deviation 9.7; four of them.
  EXPECT_NEAR(slopes, 0.95 * kTrials, 40);
  EXPECT_NEAR(intercepts, 0.95 * kTrials, 40);
}

} // namespace
} // namespace grouser::support
