// SPDX-License-Identifier: BSD-3-Clause
// Order-free sums: what they promise, and where they end.
#include "base/fixed_point.hpp"

#include "base/array.hpp"
#include "base/for_each.cuh"
#include "base/random.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace grouser::base {
namespace {

TEST(FixedPoint, SumIsTheSameInAnyOrderWhereFloatingPointsIsNot) {
  const FixedPoint f = fixedPointFor(1e6);
  std::vector<double> addends;
  for (std::uint64_t i = 0; i < 10000; ++i)
    addends.push_back((uniform(1, 2, i) - 0.5) * (i % 3 == 0 ? 1e6 : i % 3 == 1 ? 1.0 : 1e-5));
  const auto sum = [&](const std::vector<double>& list) {
    std::int64_t q = 0;
    double plain = 0;
    for (const double x : list) q += f.quantise(x), plain += x;
    return std::pair(q, plain);
  };
  std::vector<double> sorted = addends;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(sum(addends).first, sum(sorted).first);
  EXPECT_NE(sum(addends).second, sum(sorted).second) << "or the test shows nothing";
  EXPECT_NEAR(f.value(sum(addends).first), sum(sorted).second, 10000 * f.quantum);
}

TEST(FixedPoint, LargestTakesTheBitsItWasGivenAndLeavesTheStatedRoom) {
  for (const double largest : {3e-7, 1.0, 2.5e9}) {
    const FixedPoint f = fixedPointFor(largest, 42);
    EXPECT_LE(f.quantise(largest), std::int64_t{1} << 42);
    EXPECT_GE(f.quantise(largest), std::int64_t{1} << 41);
    EXPECT_NEAR(f.value(f.quantise(largest)), largest, 0.5 * f.quantum);
    // 2^20 addends of that size: the last that fit.
    const std::int64_t full = f.quantise(largest) * ((std::int64_t{1} << 20) - 1);
    EXPECT_NEAR(f.checked(full, "tests"), largest * ((1 << 20) - 1),
                1e-12 * largest * (1 << 20) + f.quantum * (1 << 20));
  }
}

TEST(FixedPoint, WhatLeavesTheRangeIsNoticed) {
  const FixedPoint f = fixedPointFor(1.0, 42);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double beyond = 5e6; // 2^62 quanta are 2^20 or 2^21
  for (const double bad : {beyond, -beyond, kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(f.checked(f.quantise(bad), "tests"), SimulationError) << bad;
  EXPECT_THROW(f.checked(f.quantise(beyond) + f.quantise(1.0), "tests"), SimulationError);
  std::int64_t sum = 0;
  for (int k = 0; k < 3; ++k) sum += f.quantise(0.5e6);
  EXPECT_NO_THROW(f.checked(sum, "tests"));
  EXPECT_THROW(f.checked({0, 0, std::int64_t{1} << 62}, "tests"), SimulationError);
}

TEST(FixedPoint, EveryFiniteScaleHasItsQuantumAndNoOtherNumberHasOne) {
  // From the least positive double on; quanta are normal numbers, so that both they and their inverse are exact.
  for (const double largest : {5e-324, 1e-310, 1e-290, 1e-280, 1.0, 1e300, 1e307})
    for (const int bits : {2, 42, 60}) {
      const FixedPoint f = fixedPointFor(largest, bits);
      EXPECT_EQ(f.quantum * f.perUnit, 1) << largest;
      EXPECT_LT(largest * f.perUnit, std::ldexp(1.0, bits)) << largest;
      if (largest >= 1e-280) {
        EXPECT_GE(largest * f.perUnit, std::ldexp(1.0, bits - 1)) << largest;
      }
      EXPECT_NEAR(f.value(f.quantise(largest)), largest, f.quantum / 2) << bits;
    }
  for (const double none : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")})
    EXPECT_THROW(fixedPointFor(none), SimulationError) << none;
}

/// Adds numbers of all sizes to one sum at once.
struct AddAll {
  FixedPoint f;
  std::int64_t* sum;
  GROUSER_HD void operator()(int i) const {
    atomicAdd64(sum, f.quantise((uniform(3, 4, static_cast<std::uint64_t>(i)) - 0.5) * (i % 2 ? 1e3 : 1e-3)));
  }
};

TEST(FixedPoint, ThreadsThatAddAtOnceGetTheSameSum) {
  const FixedPoint f = fixedPointFor(1e3);
  constexpr int kCount = 200000;
  std::int64_t one = 0;
  for (int i = 0; i < kCount; ++i) AddAll{f, &one}(i);
  for (const int threads : {1, 2, 5}) {
    const Exec exec = testExec(threads);
    Array<std::int64_t> sum(exec, 1);
    forEach(exec, "add all", kCount, AddAll{f, sum.data()});
    EXPECT_EQ(sum.toHost().front(), one);
  }
}

} // namespace
} // namespace grouser::base
