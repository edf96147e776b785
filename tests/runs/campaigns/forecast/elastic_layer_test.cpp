// SPDX-License-Identifier: BSD-3-Clause
// Settlement of loaded rectangles on an elastic layer against closed forms and tables for the half-space.
#include "runs/campaigns/forecast/elastic_layer.hpp"

#include "base/math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace grouser::forecast {
namespace {

// Mean settlement of a rectangle of area A under a uniform pressure p: m p (1 - nu^2) sqrt(A) / E; m by Timoshenko and
// Goodier, Theory of Elasticity, section 139.
TEST(ElasticLayer, WithoutAFloorIsHalfSpace) {
  for (const auto& [ratio, m] :
       {std::pair{1.0, 0.95}, {1.5, 0.94}, {2.0, 0.92}, {3.0, 0.88}, {5.0, 0.82}, {10.0, 0.71}}) {
    const double mean = layerSettlement({{3, -2, ratio, 1}}, base::kInfinity, 0.3);
    EXPECT_NEAR(mean / (1 - 0.09) / std::sqrt(4 * ratio), m, 0.006) << ratio;
    EXPECT_NEAR(layerSettlement({{3, -2, ratio, 1}}, 1e9, 0.3), mean, 1e-6) << "effectively a half-space";
  }
}

// Directly below a uniform pressure p the stress is p vertically and p (1 + 2 nu) / 2 horizontally on average.
TEST(ElasticLayer, ThatIsThinIsCompressedByWhatActsAtTheSurface) {
  for (const double nu : {0.0, 0.25, 0.4}) {
    const double depth = 1e-4;
    EXPECT_NEAR(layerSettlement({{0, 0, 2, 1}}, depth, nu) / depth, (1 + nu) * (1 - 2 * nu), 1e-3) << nu;
  }
}

TEST(ElasticLayer, SettlesLikeBoussinesqsForceFarFromALoad) {
  // Mean of a small rectangle and a distant one with equal loads: by superposition twice its own settlement, plus
  // (1 - nu^2) A / (pi r) from each other.
  const double nu = 0.2, r = 50, area = 0.1 * 0.06, own = layerSettlement({{0, 0, 0.05, 0.03}}, base::kInfinity, nu);
  const double both = layerSettlement({{0, 0, 0.05, 0.03}, {r, 0, 0.05, 0.03}}, base::kInfinity, nu);
  EXPECT_NEAR((both - own) / ((1 - nu * nu) * area / (base::kPi * r)), 1, 1e-5);
  // At depth d below, at distance R, the force displaces the solid by (1 + nu) / (2 pi E) (d^2 / R^3 + 2 (1 - nu) / R).
  for (const double d : {5.0, 50.0, 500.0}) {
    const double alone = layerSettlement({{0, 0, 0.05, 0.03}}, d, nu), R = std::hypot(r, d);
    const double two = layerSettlement({{0, 0, 0.05, 0.03}, {r, 0, 0.05, 0.03}}, d, nu);
    const double here = 2 * (1 - nu) / r, below = d * d / (R * R * R) + 2 * (1 - nu) / R;
    EXPECT_NEAR((two - alone) / ((1 + nu) / (2 * base::kPi) * area * (here - below)), 1, 1e-4) << d;
  }
}

TEST(ElasticLayer, SettlesMoreTheDeeperItIs) {
  double before = 0;
  for (const double depth : {0.1, 0.5, 0.75, 1.1, 2.0, 10.0, base::kInfinity}) {
    const double now = layerSettlement({{0, 0.7, 0.9, 0.14}, {0, -0.7, 0.9, 0.14}}, depth, 0.25);
    EXPECT_GT(now, before) << depth;
    before = now;
  }
}

} // namespace
} // namespace grouser::forecast
