// SPDX-License-Identifier: BSD-3-Clause
// The search for contact parameters.
#include "runs/bevameter/calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::bevameter {
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
  EXPECT_NEAR(nearestTrial(trials, 40).x, 2, 0.01) << "the nearest that can be";
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
  ASSERT_TRUE(t.wantsSinkage());
  const double z = t.sinkageAt(0.28);
  EXPECT_NEAR((102 / 0.28 + 5301) * std::pow(z, 0.793), 47.5, 1e-9);
  CalibrationTargets one;
  one.wanted = {{Quantity::exponent, 1}}, one.k = 1000, one.breadth = 0.28;
  EXPECT_NEAR(one.sinkageAt(0.28), 0.0475, 1e-12);
}

} // namespace
} // namespace grouser::bevameter
