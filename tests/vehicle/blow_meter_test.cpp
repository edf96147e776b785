// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/blow_meter.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::vehicle {
namespace {

TEST(BlowMeter, TakesMeansOverTenMilliseconds) {
  BlowMeter meter(1000);
  for (int i = 1; i <= 10; ++i) meter.add(0.002 * i, 1000); // at rest
  EXPECT_DOUBLE_EQ(meter.most, 1);
  EXPECT_FALSE(meter.isBlow());
  // 25 weights for 2 ms are 5.8 in the mean over 10 ms, including the static weight.
  double time = 0.02;
  for (const double up : {1000, 25'000, 1000, 1000, 1000}) meter.add(time += 0.002, up);
  EXPECT_NEAR(meter.most, 5.8, 1e-12);
  EXPECT_TRUE(meter.isBlow());
}

TEST(BlowMeter, IsTheSameInOtherStepsAndRestored) {
  BlowMeter coarse(1000), fine(1000), restored(1000);
  const auto up = [](double t) { return 1000 + 6000 * std::exp(-std::pow((t - 0.055) / 0.004, 2)); };
  for (int i = 1; i <= 20; ++i) coarse.add(0.005 * i, up(0.005 * i - 0.0025));
  for (int i = 1; i <= 100; ++i) {
    fine.add(0.001 * i, up(0.001 * i - 0.0005));
    if (i == 55) restored.restore(fine.save()); // within an averaging window
    if (i > 55) restored.add(0.001 * i, up(0.001 * i - 0.0005));
  }
  EXPECT_NEAR(coarse.most, fine.most, 0.05 * fine.most);
  EXPECT_GT(fine.most, BlowMeter::kBlow);
  EXPECT_EQ(restored.save(), fine.save());
  EXPECT_NEAR(fine.at, 0.06, 1e-12);
}

TEST(BlowMeter, WithoutWeightOrForceThereAreNone) {
  BlowMeter weightless(0), unknown(1000);
  weightless.add(0.1, 1e6), unknown.add(0.1, NAN);
  EXPECT_EQ(weightless.most, 0);
  EXPECT_EQ(unknown.most, 0);
}

} // namespace
} // namespace grouser::vehicle
