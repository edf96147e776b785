// SPDX-License-Identifier: BSD-3-Clause
#include "base/fixed_point.hpp"
#include "base/math.hpp"
#include "base/period.hpp"
#include "base/position.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace grouser::base {
namespace {

TEST(Position, RoundTripsOverItsWholeRange) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100000; ++i) {
    const auto draw = [&] { return static_cast<std::int64_t>(random() >> 22) - (std::int64_t{1} << 41); };
    const Vec3l u{draw(), draw(), draw()};
    ASSERT_EQ(toUnits(fromUnits(u)), u);
  }
}

TEST(Position, DifferencesAreExactAcrossEveryBorder) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 100000; ++i) {
    const auto draw = [&] { return static_cast<std::int64_t>(random() >> 23) - (std::int64_t{1} << 40); };
    const auto step = [&] { return static_cast<std::int64_t>(random() >> 34) - (std::int64_t{1} << 29); };
    const Vec3l a{draw(), draw(), draw()}, d{step(), step(), step()};
    const Vec3i got = difference(fromUnits(a), fromUnits(a + d));
    ASSERT_EQ(static_cast<std::int64_t>(got.x), d.x);
    ASSERT_EQ(static_cast<std::int64_t>(got.y), d.y);
    ASSERT_EQ(static_cast<std::int64_t>(got.z), d.z);
    ASSERT_EQ(difference(fromUnits(a + d), fromUnits(a)), -got) << "symmetric";
  }
}

TEST(PositionScale, ResolvesAHundredMillionthOfADiameter) {
  for (const double diameter : {1e-5, 1e-3, 0.054, 3.0}) {
    const PositionScale s = positionScale(diameter);
    EXPECT_LE(s.unit, 1e-8 * diameter);
    EXPECT_GT(s.unit, 4e-9 * diameter);
    int exponent = 0;
    EXPECT_EQ(std::frexp(s.unit, &exponent), 0.5) << "a power of two";
    EXPECT_EQ(s.unit * s.perMetre, 1);
  }
}

TEST(PositionScale, OfADiameterThatIsNoLengthEnds) {
  // Possible values of a damaged scene; their positions are then out of range.
  for (const double diameter : {0.0, 2e-320, 1e-300}) {
    const PositionScale s = positionScale(diameter);
    EXPECT_EQ(s.unit * s.perMetre, 1) << diameter;
    EXPECT_LT(s.limit(), 1e-280) << diameter;
  }
}

TEST(FixedPoint, SumsDoNotDependOnOrder) {
  const FixedPoint f = fixedPointFor(1e4, 42);
  std::mt19937_64 random(3);
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) values.push_back((static_cast<double>(random() >> 11) * 0x1p-53 - 0.5) * 1e4);
  std::int64_t forward = 0, backward = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    forward += f.quantise(values[i]);
    backward += f.quantise(values[values.size() - 1 - i]);
  }
  EXPECT_EQ(forward, backward);
}

TEST(Period, PlacesOnTheUpperBoundaryAreThoseOnTheLowerOne) {
  const Period period{{-500, 0, 0}, {2000, 0, 0}};
  const auto back = [&](std::int64_t u) { return period.periodsBack(0, u); };
  EXPECT_EQ(back(-501), 1);
  EXPECT_EQ(back(-500), 0);
  EXPECT_EQ(back(1499), 0);
  EXPECT_EQ(back(1500), -1);
  EXPECT_EQ(period.periodsBack(1, 1 << 30), 0) << "no period along y";
  EXPECT_EQ(period.wrapped({1500, 7, -9}), (Vec3l{-500, 7, -9}));
  // At half a period two images are equally near: always the same one is chosen.
  EXPECT_EQ(period.apart(fromUnits({-500, 0, 0}), fromUnits({500, 0, 0})), (Vec3l{-1000, 0, 0}));
  EXPECT_EQ(period.apart(fromUnits({500, 0, 0}), fromUnits({-500, 0, 0})), (Vec3l{-1000, 0, 0}));
  EXPECT_EQ(period.apart(fromUnits({-400, 0, 0}), fromUnits({1400, 0, 0})), (Vec3l{-200, 0, 0}));
}

TEST(ElementaryFunctions, AgreeWithTheCLibraryToAFewUlp) {
  // The bound is relative to the value, or to 1 near zeros of the function.
  double worst = 0;
  for (int i = -4000; i <= 4000; ++i) {
    const double x = 0.0031 * i;
    const auto off = [&](double got, double want) {
      worst = std::max(worst, std::fabs(got - want) / std::max(1.0, std::fabs(want)));
    };
    off(sin(x), std::sin(x)), off(cos(x), std::cos(x)), off(atan(x), std::atan(x)), off(exp(x), std::exp(x));
    if (x > 0) off(log(x), std::log(x)), off(pow(x, 1.7), std::pow(x, 1.7));
    for (int j = -3; j <= 3; ++j) off(atan2(x, j), std::atan2(x, static_cast<double>(j)));
    if (std::fabs(x) <= 1) off(asin(x), std::asin(x));
  }
  EXPECT_LT(worst, 4e-15) << "about 16 ulp of 1";
}

} // namespace
} // namespace grouser::base
