// SPDX-License-Identifier: BSD-3-Clause
// Compensated float sums against the same sums in double.
#include "base/random.hpp"
#include "terrain/compensated_sum.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::terrain {
namespace {

using Remainder = std::int16_t; ///< as in addCompensated()

/// A float with its remainder.
struct Sum {
  float value = 0;
  Remainder remainder = 0;
  double add(double increment) { return addCompensated(value, remainder, increment).sum; }
};

TEST(CompensatedSum, AMillionSmallStepsAreNotLost) {
  // g dt at a step of 1e-6 s: a plain float loses 2 % of it at 1 m/s and more.
  const double increment = 9.81e-6;
  Sum sum;
  float plain = 0;
  for (int k = 0; k < 1'000'000; ++k) sum.add(increment), plain += static_cast<float>(increment);
  EXPECT_GT(std::fabs(static_cast<double>(plain) - 9.81), 0.01);
  // Each step rounds to a quantum of 2^-39 of the power of two below the value, at most 8: half of it, a million times,
  // would be 7e-6; steps round up as often as down.
  EXPECT_NEAR(static_cast<double>(sum.value), 9.81, 1e-6);
}

TEST(CompensatedSum, EveryStepIsRightToAQuantum) {
  Sum sum;
  for (int k = 0; k < 20000; ++k) {
    const double increment = (base::uniform(1, base::purpose("test.sum"), static_cast<std::uint64_t>(k)) - 0.5) * 1e-3;
    const Sum before = sum;
    const double returned = sum.add(increment);
    // The stored values before and after: value and remainder, read by adding zero.
    Sum copy = sum, former = before;
    const double now = copy.add(0), then = former.add(0);
    const double quantum = std::ldexp(1.0, std::ilogb(std::fabs(sum.value) + 1e-30f)) * 0x1p-39;
    ASSERT_NEAR(now, then + increment, quantum) << k;
    ASSERT_NEAR(returned, then + increment, 0x1p-52) << "the return value is the sum before it is stored";
    ASSERT_EQ(sum.value, static_cast<float>(returned)) << "the float is the nearest";
  }
}

TEST(CompensatedSum, ZeroAndTinyNumbersHaveARemainderToo) {
  Sum sum;
  sum.add(0);
  EXPECT_EQ(sum.value, 0);
  EXPECT_EQ(sum.remainder, 0);
  sum.add(1e-45), sum.add(-1e-45);
  EXPECT_NEAR(static_cast<double>(sum.value), 0, 1e-40);
}

} // namespace
} // namespace grouser::terrain
