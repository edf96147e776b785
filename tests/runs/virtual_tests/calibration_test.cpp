// SPDX-License-Identifier: BSD-3-Clause
// The search for contact parameters.
#include "runs/virtual_tests/calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::virtual_tests {
namespace {

TEST(CalibrationSearch, FindsWhereARisingFunctionIsWanted) {
  const auto angle = [](double way) { return 21.75 + 12 * (1 - std::exp(-way)); };
  std::vector<Trial> trials{{0, angle(0)}};
  while (const auto next = nextTrial(trials, 28, 0.2, -1, 2, 12)) trials.push_back({*next, angle(*next)});
  EXPECT_NEAR(nearestTrial(trials, 28).y, 28, 0.2);
  EXPECT_LE(trials.size(), 5u);
}

TEST(CalibrationSearch, EndsAtTheEndOfTheRangeWhereNothingReaches) {
  const auto angle = [](double way) { return 20 + 5 * way; };
  std::vector<Trial> trials{{0, angle(0)}};
  while (const auto next = nextTrial(trials, 40, 0.2, -1, 2, 12)) trials.push_back({*next, angle(*next)});
  EXPECT_NEAR(nearestTrial(trials, 40).x, 2, 0.01) << "the nearest possible value";
  EXPECT_LE(trials.size(), 8u);
}

TEST(CalibrationSearch, DoesNotGoOnForEverWithScatter) {
  std::vector<Trial> trials{{0, 10}};
  int k = 0;
  while (const auto next = nextTrial(trials, 20, 1e-9, -1, 2, 12)) {
    trials.push_back({*next, 20 + ((++k % 2) ? 3.0 : -3.0)});
    ASSERT_LT(k, 20);
    EXPECT_GE(*next, -1);
    EXPECT_LE(*next, 2);
  }
}

/// A soil with a pull that also increases its angle, as in cohesive grains.
struct Sticky {
  double wayToPhi = 9, pullToPhi = 0.012, pullToC = 0.005, most = 1e9;
  bool report(StrengthSearch& search) const {
    const StrengthPoint at = search.at();
    return search.tried(24 + wayToPhi * at.way + pullToPhi * at.pull, std::min(most, 0.3 + pullToC * at.pull));
  }
};

TEST(CalibrationSearch, FindsAngleAndCohesionThatDependOnBothNumbers) {
  StrengthSearch search({{29.8, 1, 12}}, {{3.7, 0.5, 0.0165}}, {0.48, 220});
  const Sticky soil;
  int trials = 1;
  while (soil.report(search)) ++trials;
  EXPECT_LE(trials, 5);
  const StrengthPoint found = search.nearest();
  EXPECT_NEAR(24 + 9 * found.way + 0.012 * found.pull, 29.8, 1);
  EXPECT_NEAR(0.3 + 0.005 * found.pull, 3.7, 0.5);
}

/// Tests are reused only from a trial of an identical soil: the last digit counts.
TEST(CalibrationSearch, TheNearestIsWhatWasTriedToTheBit) {
  const double tolerance = 0.7, slope = 0.75e-3 / 0.007 * std::tan(31.1 * 3.141592653589793 / 180);
  for (double pull = 1; pull < 100; ++pull) {
    const StrengthPoint start{0.56 + 1e-3 * pull, pull};
    StrengthSearch search({{31.1, 1.2, 12}}, {{1.3, tolerance, slope}}, start);
    EXPECT_FALSE(search.tried(31.1, 1.3));
    EXPECT_EQ(search.nearest().pull, start.pull);
    EXPECT_EQ(search.nearest().way, start.way);
  }
}

TEST(CalibrationSearch, NumbersThatAreTriedHaveFourDigits) {
  EXPECT_EQ(fourDigits(1645189418.8213131), 1.645e9);
  EXPECT_EQ(fourDigits(-0.29584732191569063), -0.2958);
  EXPECT_EQ(fourDigits(0), 0);
  StrengthSearch search({{29.8, 1, 12}}, {{3.7, 0.5, 0.0165}}, {0.48, 220});
  ASSERT_TRUE(search.tried(26, 1.1));
  EXPECT_EQ(search.at().way, fourDigits(search.at().way));
  EXPECT_EQ(search.at().pull, fourDigits(search.at().pull));
}

TEST(CalibrationSearch, MayLeaveOneOfBothAlone) {
  StrengthSearch onlyAngle({{28, 0.2, 12}}, {}, {0.1, 50});
  while (onlyAngle.tried(22 + 10 * onlyAngle.at().way, 1)) EXPECT_EQ(onlyAngle.at().pull, 50);
  EXPECT_NEAR(onlyAngle.nearest().way, 0.6, 0.02);
  EXPECT_EQ(onlyAngle.nearest().pull, 50);
  StrengthSearch onlyC({}, {{3.7, 0.5, 0.054}}, {0.4, 10}); // the soil needs a far larger pull than expected
  int trials = 1;
  while (onlyC.tried(30, 0.3 + 0.016 * onlyC.at().pull)) EXPECT_EQ(onlyC.at().way, 0.4), ++trials;
  EXPECT_NEAR(0.3 + 0.016 * onlyC.nearest().pull, 3.7, 0.5);
  EXPECT_LE(trials, 4) << "the second trial yields the slope";
}

TEST(CalibrationSearch, StaysInRangeAndEndsWhereNothingReaches) {
  StrengthSearch search({{50, 1, 12}}, {{3.7, 0.5, 0.0165}}, {0.5, 100});
  const Sticky soil{.pullToPhi = 0, .most = 1};
  int trials = 1;
  while (soil.report(search)) {
    ++trials;
    EXPECT_GE(search.at().way, -1);
    EXPECT_LE(search.at().way, 2);
    EXPECT_GE(search.at().pull, 0);
  }
  EXPECT_LE(trials, 8);
  EXPECT_NEAR(search.nearest().way, 2, 0.01) << "the nearest possible value";
}

TEST(CalibrationSearch, WhatDoesNotAnswerIsGivenUpSoon) {
  std::vector<Trial> trials{{20, 3.1}};
  while (const auto next = nextTrial(trials, 3.9, 0.1, 18, 24.6, 0.5)) trials.push_back({*next, 3.1});
  EXPECT_LE(trials.size(), 3u);
}

TEST(CalibrationSearch, StrengthGoesFromNoFrictionToAllOfIt) {
  EXPECT_EQ(strengthAt(0, 0.5).friction, 0.5);
  EXPECT_EQ(strengthAt(0, 0.5).rollingFriction, 0);
  EXPECT_EQ(strengthAt(1, 0.5).rollingFriction, 0.5);
  EXPECT_EQ(strengthAt(2, 0.5).friction, 1);
  EXPECT_LT(strengthAt(-0.9, 0.5).friction, 0.06);
  EXPECT_NEAR(strengthAt(wayOf(0.2), 0.5).rollingFriction, 0.2, 1e-12);
  for (double way = -1; way < 2; way += 0.1) {
    EXPECT_LE(strengthAt(way, 0.5).friction, strengthAt(way + 0.1, 0.5).friction);
    EXPECT_LE(strengthAt(way, 0.5).rollingFriction, strengthAt(way + 0.1, 0.5).rollingFriction);
  }
}

TEST(CalibrationTargets, SinkageIsThatOfBekkersForm) {
  CalibrationTargets t;
  t.wanted = {{Quantity::exponent, 0.793}, {Quantity::cohesionModulus, 102}, {Quantity::frictionModulus, 5301}};
  ASSERT_TRUE(t.requestsSinkage());
  const double z = t.sinkageAt(0.28);
  EXPECT_NEAR((102 / 0.28 + 5301) * std::pow(z, 0.793), 47.5, 1e-9);
  CalibrationTargets one;
  one.wanted = {{Quantity::exponent, 1}}, one.k = 1000, one.breadth = 0.28;
  EXPECT_NEAR(one.sinkageAt(0.28), 0.0475, 1e-12);
}

} // namespace
} // namespace grouser::virtual_tests
