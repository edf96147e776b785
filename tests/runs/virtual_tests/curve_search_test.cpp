// SPDX-License-Identifier: BSD-3-Clause
// The search for measured curves, tested on functions with a known minimum.
#include "runs/virtual_tests/curve_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace grouser::virtual_tests::curve_search {
namespace {

const std::vector<SearchRange> kRanges{
    {"young", 1e7, 1e9, true}, {"friction", 0.2, 1.0, false}, {"porosity", 0.4, 0.5, false}};

/// Residuals of pressures that are powers of the parameters, as for plates, about known values.
std::vector<double> powers(const std::vector<double>& x, double scatter = 0) {
  std::vector<double> residuals;
  for (int k = 0; k < 8; ++k) {
    const double value =
        0.2 * std::log(x[0] / 1e8) * (1 + 0.1 * k) + 2 * std::log(x[1] / 0.6) + 30 * (0.46 - x[2]) * (1 - 0.12 * k);
    // Deterministic scatter: the same values give the same residuals.
    const double phase = std::sin(1e3 * x[1] + 17 * k + 1e4 * x[2]);
    residuals.push_back((value + scatter * phase) / 0.05);
  }
  return residuals;
}

int search(CurveSearch& s, double scatter) {
  int trials = 1;
  while (s.tried(powers(s.at(), scatter))) ++trials;
  return trials;
}

TEST(CurveSearch, FindsWhereAllCurvesAreMet) {
  CurveSearch s(kRanges, {3e7, 0.4, 0.44}, 20);
  const int trials = search(s, 0);
  const CurveSearch::Trial& found = s.trials()[s.nearest()];
  EXPECT_LE(trials, 16);
  // The search ends when no step reduces the sum of squares by 1.
  EXPECT_LT(found.misfit(), std::sqrt(1.0 / 8));
  // Friction and porosity compensate each other along a valley of that height.
  EXPECT_NEAR(found.values[1], 0.6, 0.08);
  EXPECT_NEAR(found.values[2], 0.46, 0.004);
}

TEST(CurveSearch, ComesAsNearAsScatterAllows) {
  CurveSearch s(kRanges, {3e7, 0.4, 0.44}, 20);
  search(s, 0.05);
  const CurveSearch::Trial& found = s.trials()[s.nearest()];
  EXPECT_LT(found.misfit(), 1.5) << "the scatter alone yields 0.7";
  EXPECT_NEAR(found.values[1], 0.6, 0.08);
  EXPECT_NEAR(found.values[2], 0.46, 0.006);
}

TEST(CurveSearch, StaysInItsRangesAndEndsAtTheNearestBound) {
  const auto away = [](const std::vector<double>& x) {
    return std::vector<double>{20 * (x[0] - 3), 10 * (x[1] - 0.5)}; // the minimum for the first is outside its range
  };
  CurveSearch s({{"friction", 0, 1, false}, {"rolling_friction", 0, 1, false}}, {0.2, 0.2}, 20);
  bool continues = true;
  while (continues) {
    for (const double x : s.at()) EXPECT_TRUE(x >= 0 && x <= 1) << x;
    continues = s.tried(away(s.at()));
  }
  const CurveSearch::Trial& found = s.trials()[s.nearest()];
  EXPECT_NEAR(found.values[0], 1, 1e-3);
  EXPECT_NEAR(found.values[1], 0.5, 0.16) << "the search stops when a step saves too little";
  EXPECT_LT(s.trials().size(), 12u);
}

TEST(CurveSearch, FirstVariesOneParameterAtATime) {
  CurveSearch s(kRanges, {1e8, 0.9, 0.44}, 20);
  const std::vector<double> start = s.at();
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_TRUE(s.tried(powers(s.at())));
    for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(s.at()[j] != start[j], j == k) << j;
  }
  EXPECT_LT(s.trials()[2].values[1], 0.9) << "a step up would leave the range";
}

TEST(CurveSearch, OneTrialTestsTheStartAlone) {
  CurveSearch s(kRanges, {1e8, 0.6, 0.46}, 1);
  EXPECT_FALSE(s.tried({3, 4}));
  EXPECT_EQ(s.nearest(), 0u);
  EXPECT_NEAR(s.trials()[0].misfit(), std::sqrt(12.5), 1e-12);
}

} // namespace
} // namespace grouser::virtual_tests::curve_search
