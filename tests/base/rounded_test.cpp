// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounded.hpp"

#include "base/counted.hpp"
#include "base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace grouser::base {
namespace {

TEST(Rounded, KeepsTheLimitThatItPrints) {
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    const double value =
        (uniform(1, 2, i, 0) + 0.1) * std::pow(10.0, std::floor(40 * uniform(1, 2, i, 1)) - 20) * (i % 3 ? 1 : -1);
    for (const int digits : {1, 2, 3, 6, 17}) {
      const double down = std::strtod(roundedDown(value, digits).c_str(), nullptr),
                   up = std::strtod(roundedUp(value, digits).c_str(), nullptr);
      ASSERT_LE(down, value) << digits;
      ASSERT_GE(up, value) << digits;
      // One unit of the last digit is at most this share of the number.
      ASSERT_LE(up - down, std::fabs(value) * std::pow(10.0, 1 - digits) * (1 + 1e-9)) << digits;
    }
  }
}

TEST(Rounded, IsTheNumberItselfWhereItHasSoFewDigits) {
  EXPECT_EQ(roundedDown(1.2e-4, 3), "0.00012");
  EXPECT_EQ(roundedUp(1.2e-4, 3), "0.00012");
  EXPECT_EQ(roundedDown(1.19999e-4, 2), "0.00011");
  EXPECT_EQ(roundedDown(std::nextafter(1e-4, 0), 3), "9.99e-05");
  EXPECT_EQ(roundedUp(0.5, 1), "0.5");
  EXPECT_EQ(roundedDown(0, 3), "0");
  EXPECT_EQ(roundedDown(INFINITY, 3), "inf");
}

TEST(NearestDecimal, LeavesOutWhatTheProductOfAStepHasAdded) {
  EXPECT_NE(5900 * 1e-4, 0.59);
  EXPECT_EQ(nearestDecimal(5900 * 1e-4), 0.59);
  for (int n = 0; n < 20000; ++n) {
    const double decimal =
        std::strtod((std::to_string(n / 10000) + "." + std::to_string(10000 + n % 10000).substr(1)).c_str(), nullptr);
    EXPECT_EQ(nearestDecimal(n * 1e-4), decimal) << n;
  }
  EXPECT_EQ(nearestDecimal(1.0 / 3), 0.333333333333333);
}

TEST(Counted, NamesOneAsOne) {
  EXPECT_EQ(counted(1, "seed"), "1 seed");
  EXPECT_EQ(counted(0, "seed"), "0 seeds");
  EXPECT_EQ(counted(std::size_t{2}, "run is", "runs are"), "2 runs are");
}

} // namespace
} // namespace grouser::base
