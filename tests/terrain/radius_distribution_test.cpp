// SPDX-License-Identifier: BSD-3-Clause
// Radii of beds: samples against the closed forms of their distributions.
#include "terrain/radius_distribution.hpp"

#include "base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace grouser::terrain {

namespace {

constexpr int kDrawn = 200'000;

std::vector<double> drawn(const RadiusDistribution& d) {
  std::vector<double> radii;
  for (std::uint64_t id = 0; id < kDrawn; ++id)
    radii.push_back(d.draw([&](std::uint64_t k) { return base::uniform(7, base::purpose("test"), id, k); }));
  return radii;
}

RadiusDistribution uniform() { return {RadiusLaw::uniform, 0.02, 0.25, {}, {}}; }
RadiusDistribution lognormal() { return {RadiusLaw::lognormal, 0.01, 0.3, {}, {}}; }
RadiusDistribution sieves() { return {RadiusLaw::sieve, 0, 0, {0.004, 0.01, 0.02, 0.04}, {0, 0.3, 0.3, 1}}; }

} // namespace

TEST(RadiusDistribution, MomentsOfDrawnRadiiAreThoseComputed) {
  for (const RadiusDistribution& d : {uniform(), lognormal(), sieves()}) {
    const std::vector<double> radii = drawn(d);
    for (int power = 1; power <= 4; ++power) {
      double sum = 0, squares = 0;
      for (const double r : radii) sum += std::pow(r, power), squares += std::pow(r, 2 * power);
      const double mean = sum / kDrawn, error = std::sqrt((squares / kDrawn - mean * mean) / kDrawn);
      EXPECT_NEAR(d.meanPower(power), mean, 4 * error) << "law " << static_cast<int>(d.law) << ", power " << power;
    }
  }
}

TEST(RadiusDistribution, StaysBetweenSmallestAndLargest) {
  // A sieve with no residue, and one with no throughput, contain no grain.
  const RadiusDistribution emptyEnds{RadiusLaw::sieve, 0, 0, {0.001, 0.004, 0.01, 0.02, 0.5}, {0, 0, 0.4, 1, 1}};
  for (const RadiusDistribution& d : {uniform(), lognormal(), sieves(), emptyEnds}) {
    const std::vector<double> radii = drawn(d);
    const auto [least, most] = std::minmax_element(radii.begin(), radii.end());
    EXPECT_GE(*least, d.smallest() * (1 - 1e-12));
    EXPECT_LE(*most, d.largest() * (1 + 1e-12));
    EXPECT_LT(*least, d.smallest() * 1.02) << "and comes close to them";
    EXPECT_GT(*most, d.largest() * 0.95);
  }
}

TEST(RadiusDistribution, UniformHasItsClosedForms) {
  const RadiusDistribution d = uniform();
  EXPECT_NEAR(d.meanPower(3), std::pow(0.02, 3) * (1 + 0.25 * 0.25), 1e-18);
  EXPECT_NEAR(d.deviation(), 0.25 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(d.skewness(), 0, 1e-9);
}

TEST(RadiusDistribution, MassThatPassesASieveIsAsTheCurveSays) {
  const RadiusDistribution d = sieves();
  double all = 0, below[4] = {};
  for (const double r : drawn(d)) {
    const double mass = r * r * r;
    all += mass;
    for (int k = 0; k < 4; ++k) below[k] += 2 * r <= d.sieveDiameter[static_cast<std::size_t>(k)] ? mass : 0;
  }
  // The few largest grains contain most of the mass: their number scatters by 2 %.
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(below[k] / all, d.passing[k], 0.03) << k;
  EXPECT_NEAR(d.medianByMass(), 0.5 * 0.02 * std::pow(2, 0.2 / 0.7), 1e-12);
}

TEST(RadiusDistribution, HalfOfTheMassIsFinerThanTheMedian) {
  for (const RadiusDistribution& d : {uniform(), lognormal()}) {
    const double median = d.medianByMass();
    double all = 0, below = 0;
    for (const double r : drawn(d)) all += r * r * r, below += r <= median ? r * r * r : 0;
    EXPECT_NEAR(below / all, 0.5, 0.01);
  }
}

TEST(RadiusDistribution, CloseRandomPackingIsThatOfTheLiterature) {
  EXPECT_DOUBLE_EQ(randomClosePacking({RadiusLaw::single, 0.01, 0, {}, {}}), 0.634);
  // Desmond and Weeks 2014, figure 2: 0.64 to 0.65 at a deviation of 0.15 without skewness.
  EXPECT_NEAR(randomClosePacking(uniform()), 0.6435, 2e-4);
}

TEST(DepthGrading, GrowsBelowTheFineDepthUntilTheCoarsestRadius) {
  const DepthGrading g{0.2, 0.05, 0.04};
  EXPECT_EQ(g.scaleAt(0.1, 0.02), 1);
  EXPECT_DOUBLE_EQ(g.scaleAt(0.4, 0.02), 1.5);
  EXPECT_EQ(g.scaleAt(3, 0.02), 2);
  EXPECT_EQ(DepthGrading{}.scaleAt(3, 0.02), 1);
}

/// Grains per volume decrease with the cube of the scale s = 1 + c z: their mean of s^4 is the integral of s over
/// that of 1 / s^3.
TEST(DepthGrading, AMeanGrainIsHeavierThanOneAtTheSurface) {
  const double c = 5, depth = 0.6, end = 1 + c * depth;
  EXPECT_NEAR((DepthGrading{0, c * 0.02, 1}.meanFourthPower(depth, 0.02)),
              (depth + c * depth * depth / 2) * 2 * c / (1 - 1 / (end * end)), 1e-4);
  EXPECT_NEAR((DepthGrading{0.3, 1e6, 0.04}.meanFourthPower(depth, 0.02)), (1 + 2) / (1 + 1 / 8.), 1e-3);
  EXPECT_EQ((DepthGrading{0.3, 0, 0.04}.meanFourthPower(depth, 0.02)), 1);
}

} // namespace grouser::terrain
