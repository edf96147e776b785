// SPDX-License-Identifier: BSD-3-Clause
// Intervals of the constants of the soil contact model, and samples of their joint distribution.
#include "runs/scene/soil_constants.hpp"

#include "base/math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace grouser::scene {
namespace {

using Q = SoilQuantity;
using Constants = std::vector<ContactConstant>;

Soil soil(const std::string& name) { return readSoil(GROUSER_SOURCE_DIR "/assets/soils/" + name + ".toml"); }

const ContactConstant& of(const Constants& constants, Q quantity) {
  for (const ContactConstant& c : constants)
    if (c.quantity == quantity) return c;
  throw std::logic_error("missing");
}

double tangent(const Constants& c) { return std::tan(of(c, Q::frictionAngle).value * base::kPi / 180); }
double modulus(const Constants& c) {
  return of(c, Q::cohesiveModulus).value / kReferenceWidth + of(c, Q::frictionalModulus).value;
}

/// Mean, deviation and correlation of two series.
struct Pair {
  double meanX = 0, meanY = 0, deviationX = 0, deviationY = 0, correlation = 0;
};
Pair statistics(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  Pair p;
  for (std::size_t i = 0; i < x.size(); ++i) p.meanX += x[i] / n, p.meanY += y[i] / n;
  double xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = x[i] - p.meanX, b = y[i] - p.meanY;
    xx += a * a, yy += b * b, xy += a * b;
  }
  p.deviationX = std::sqrt(xx / n), p.deviationY = std::sqrt(yy / n), p.correlation = xy / std::sqrt(xx * yy);
  return p;
}

TEST(SoilConstants, PublishedOnesWithoutASpanHaveAssumedIntervals) {
  const Constants lete = contactConstants(soil("lete_sand"), SoilConstantsFrom::published);
  ASSERT_EQ(lete.size(), kContactQuantities.size());
  for (const ContactConstant& c : lete) EXPECT_TRUE(c.isAssumed) << base::wordOf(c.quantity);
  EXPECT_NEAR(of(lete, Q::exponent).halfWidth(), 1.96 * 0.05 * 0.793, 1e-5);
  EXPECT_NEAR(of(lete, Q::cohesion).halfWidth(), 1.96 * 0.20 * 1300, 0.1);
  // k = p / z^n at z = 2.57 mm, with 10 % of p and 5 % of n.
  const double k = 102e3 / 0.28 + 5301e3, z = std::pow(50e3 / k, 1 / 0.793);
  const double deviation = std::hypot(0.1, 0.05 * 0.793 * std::log(z));
  EXPECT_NEAR(of(lete, Q::frictionalModulus).deviation, deviation, 1e-9);
  EXPECT_EQ(of(lete, Q::cohesiveModulus).deviation, of(lete, Q::frictionalModulus).deviation);
  EXPECT_NEAR(modulusCorrelation(lete), std::sqrt(1 - 0.01 / (deviation * deviation)), 1e-9);
  EXPECT_NE(jointDistributionText(lete).find("assumed"), std::string::npos);
}

TEST(SoilConstants, ASpanOfSourcesAndAMeasuredHalfWidthAreTheirIntervals) {
  const Constants dry = contactConstants(soil("dry_sand"), SoilConstantsFrom::published);
  EXPECT_FALSE(of(dry, Q::shearModulus).isAssumed);
  EXPECT_NEAR(of(dry, Q::shearModulus).halfWidth(), 0.005, 1e-12); // 20 to 25 mm; the value is 25
  const Constants gravel = contactConstants(soil("gravel"), SoilConstantsFrom::published);
  EXPECT_NEAR(of(gravel, Q::frictionAngle).halfWidth(), 5, 0.05); // 30 to 39, the value is 34; the tangent is nonlinear
  const Constants lete = contactConstants(soil("lete_sand"), SoilConstantsFrom::measured);
  for (const ContactConstant& c : lete) EXPECT_FALSE(c.isAssumed);
  EXPECT_NEAR(of(lete, Q::cohesion).halfWidth(), 187.5, 1e-9);
  EXPECT_NEAR(of(lete, Q::frictionAngle).halfWidth(), 0.6494, 1e-3);
}

TEST(SoilConstants, MeasuredOnesAreOfOneSizeOfGrains) {
  const Constants loam = contactConstants(soil("grenville_loam"), SoilConstantsFrom::measured);
  ASSERT_EQ(loam.size(), kContactQuantities.size());
  EXPECT_EQ(of(loam, Q::exponent).value, 1.005) << "measured with grains of 14 mm radius only";
  EXPECT_EQ(of(loam, Q::cohesion).value, 2480) << "from the same grains, not those of 7 mm";
  EXPECT_EQ(of(loam, Q::shearModulus).value, 0.01);
}

TEST(SoilConstants, ASampleIsTheSameOnEveryMachine) {
  Constants one = contactConstants(soil("lete_sand"), SoilConstantsFrom::published), again = one, other = one;
  drawContactConstants(one, 1), drawContactConstants(again, 1), drawContactConstants(other, 2);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].value, again[i].value);
    EXPECT_NE(one[i].value, other[i].value);
  }
  // Computed independently of the program, with another mathematical library.
  EXPECT_DOUBLE_EQ(of(one, Q::exponent).value, 0.731155288641434);
  EXPECT_DOUBLE_EQ(of(one, Q::frictionalModulus).value, 3289636.270124886);
  EXPECT_DOUBLE_EQ(of(one, Q::frictionAngle).value, 32.38363415893085);
}

/// Tolerances: 4 standard errors of 4000 samples, and the effect of limits at 3 deviations on the deviation, 1.4 %.
TEST(SoilConstants, SamplesHaveTheDeviationsAndCorrelationsStated) {
  const Constants nominal = contactConstants(soil("lete_sand"), SoilConstantsFrom::published);
  const double z = std::pow(kReferencePressure / modulus(nominal), 1 / of(nominal, Q::exponent).value);
  std::vector<double> n, k, p, c, friction, shear;
  constexpr int kSamples = 4000;
  for (int number = 1; number <= kSamples; ++number) {
    Constants drawn = nominal;
    drawContactConstants(drawn, number);
    n.push_back(of(drawn, Q::exponent).value), k.push_back(std::log(modulus(drawn)));
    p.push_back(k.back() + n.back() * std::log(z));
    c.push_back(std::log(of(drawn, Q::cohesion).value)), friction.push_back(std::log(tangent(drawn)));
    shear.push_back(std::log(of(drawn, Q::shearModulus).value));
  }
  const double error = 4 / std::sqrt(double{kSamples});
  const Pair pressure = statistics(n, p);
  EXPECT_NEAR(pressure.meanY, std::log(kReferencePressure), 0.10 * error);
  EXPECT_NEAR(pressure.deviationY, 0.10, 0.10 * (error / std::sqrt(2) + 0.014));
  EXPECT_NEAR(pressure.correlation, 0, error) << "the pressure is independent of n";
  EXPECT_NEAR(pressure.deviationX / 0.793, 0.05, 0.05 * (error / std::sqrt(2) + 0.014));
  EXPECT_NEAR(statistics(n, k).correlation, modulusCorrelation(nominal), 0.01);
  const Pair strength = statistics(c, friction);
  EXPECT_NEAR(strength.correlation, -0.5, 0.75 * error);
  EXPECT_NEAR(strength.deviationX, std::sqrt(std::log(1.04)), 0.2 * (error / std::sqrt(2) + 0.014));
  EXPECT_NEAR(strength.deviationY, 0.05, 0.05 * (error / std::sqrt(2) + 0.014));
  EXPECT_NEAR(std::exp(statistics(shear, shear).meanX), 0.012, 0.012 * 0.25 * error) << "the median is the nominal K";
}

TEST(SoilConstants, AGivenConstantIsNotDrawn) {
  Constants constants = contactConstants(soil("lete_sand"), SoilConstantsFrom::published);
  for (ContactConstant& c : constants)
    if (c.quantity != Q::exponent) c.deviation = 0;
  const Constants nominal = constants;
  const double sinkage = std::log(kReferencePressure / modulus(nominal)) / 0.793;
  double squares = 0;
  constexpr int kSamples = 400;
  for (int number = 1; number <= kSamples; ++number) {
    constants = nominal;
    drawContactConstants(constants, number);
    EXPECT_EQ(modulus(constants), modulus(nominal));
    EXPECT_EQ(of(constants, Q::cohesion).value, 1300);
    squares += std::pow((of(constants, Q::exponent).value - 0.793) * sinkage, 2);
  }
  EXPECT_NEAR(std::sqrt(squares / kSamples), kPressureDeviation, 0.015) << "n alone scatters the pressure";
}

} // namespace
} // namespace grouser::scene
