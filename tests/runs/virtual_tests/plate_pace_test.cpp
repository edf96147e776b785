// SPDX-License-Identifier: BSD-3-Clause
// Speed of plates, and pressure added by motion.
#include "runs/virtual_tests/plan.hpp"
#include "runs/virtual_tests/plate_pace.hpp"
#include "runs/virtual_tests/plate_sinkage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace grouser::virtual_tests {
namespace {

/// Waves may add 2 kPa to the track's 47.5 kPa.
PlatePace pace() {
  PlatePace p;
  p.density = 1500, p.breadth = 0.28, p.depth = 0.56, p.added = 2e3, p.fastest = 0.1, p.firstModulus = 16e6;
  return p;
}

TEST(PlatePace, WavesAddThePressureThatTheyMay) {
  const PlatePace p = pace();
  for (const double modulus : {1e6, 4e6, 16e6}) {
    const double wave = std::sqrt(modulus / p.density);
    EXPECT_NEAR(p.density * wave * p.speedAt(modulus), 2e3, 1e-9) << modulus;
    EXPECT_NEAR(p.wavesBack(modulus), 2 * 0.56 / wave, 1e-12);
  }
  EXPECT_EQ(p.first(), p.speedAt(16e6));
  EXPECT_EQ(p.speedAt(1e3), 0.1) << "in soft soil the inertial number limits the speed";
  EXPECT_EQ(p.speedAt(0), 0.1);
  EXPECT_TRUE(std::isfinite(p.wavesBack(0)));
}

TEST(PlatePace, SlowsDownAtOnceAndSpeedsUpByHalf) {
  const PlatePace p = pace();
  const double v = p.speedAt(4e6);
  EXPECT_EQ(p.next(v, 4e6), v);
  EXPECT_EQ(p.next(v, 4e6 * 1.3), v) << "no change within the tolerance";
  EXPECT_EQ(p.next(v, 64e6), p.speedAt(64e6));
  EXPECT_NEAR(p.next(0.01, 1e6) / 0.01, 1.5, 1e-12);
}

TEST(ShownModulus, IsTheSteeperOfTheWholeWayAndItsEnd) {
  std::vector<double> z, p;
  for (int i = 0; i < 64; ++i) z.push_back(1e-4 * i), p.push_back(5e6 * z.back());
  EXPECT_NEAR(apparentModulus(z, p, 0.28, 32), 1.4e6, 1e-3);
  for (int i = 64; i < 96; ++i) z.push_back(1e-4 * i), p.push_back(p.back() + 2e3);
  EXPECT_NEAR(apparentModulus(z, p, 0.28, 32), 0.28 * 2e7, 1e-3) << "the curve is steeper at its end";
  for (int i = 96; i < 160; ++i) z.push_back(1e-4 * i), p.push_back(p.back());
  EXPECT_GT(apparentModulus(z, p, 0.28, 32), 1e6) << "a yielded bed still has the layers below";
  std::vector<double> up(z.rbegin(), z.rend()), falling(p.rbegin(), p.rend());
  EXPECT_GT(apparentModulus(up, falling, 0.28, 32), 1e6) << "also for an upward plate";
  EXPECT_EQ(apparentModulus(std::vector<double>{1e-3}, std::vector<double>{5}, 0.28, 32), 0);
}

TEST(PlatePace, OfStiffGrainsBeginsMoreSlowly) {
  const auto first = [](double young) {
    TestedSoil soil;
    soil.young = young, soil.poisson = 0.25, soil.density = 2650, soil.grainRadius = 0.007, soil.friction = 0.5;
    soil.law = "young = 1e8\n";
    const TestPlan plan = planOf(soil, PlanOptions{});
    EXPECT_EQ(plan.small.added, 0.04 * kTrackPressure);
    return plan.small.pace(plan.grains).first();
  };
  // Hertz' contacts: overlap scales with E^(-2/3), the speed with its square root.
  EXPECT_NEAR(first(8e7) / first(8e8), std::pow(10, 1.0 / 3), 1e-6);
  EXPECT_NEAR(first(8e8), 0.0118, 0.0005) << "[m/s]";
}

TEST(AddedByMotion, IsWhatIsGoneWhenThePlateIsHeld) {
  jobs::Table run;
  run.names = kSinkageColumns;
  const auto row = [&](double phase, double p) { run.rows.push_back({phase, 0, p, 0.4, 1, 1, 1, 1, 1}); };
  for (int i = 0; i < 20; ++i) row(0, 100e3);
  EXPECT_TRUE(std::isnan(addedByMotion(run))) << "from an older run";
  for (int i = 0; i < 12; ++i) row(3, 80e3);
  for (int i = 0; i < 4; ++i) row(3, 95e3);
  EXPECT_NEAR(addedByMotion(run), 0.05, 1e-12) << "after the waves have decayed";
}

} // namespace
} // namespace grouser::virtual_tests
