// SPDX-License-Identifier: BSD-3-Clause
// Laws of a point and of a pad element against closed forms (Bekker, Wong, Janosi), for four soils of Wong's book.
#include "scm/compaction.hpp"
#include "scm/shear.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace grouser::scm {
namespace {

constexpr double kBreadth = 0.28, kPressure = 47.5e3; // [m], [Pa] of the paper's light vehicle

struct Soil {
  const char* name;
  SoilConstants constants;
  double k;                        ///< k_c / b + k_phi
  double sinkage, deeper;          ///< [mm] at 47.5 and 60 kPa
  double work;                     ///< [J/m2] to 47.5 kPa
  double stiffness, rebound, held; ///< [MPa/m], [mm], [J/m2] at f = 10
  double traction[5];              ///< [kN] of two tracks of 1.85 m at a slip of 2, 5, 10, 20, 50 %
};

SoilConstants constants(double n, double kc, double kphi, double c, double phi, double K) {
  SoilConstants s;
  s.exponent = n, s.kc = 1e3 * kc, s.kphi = 1e3 * kphi, s.cohesion = 1e3 * c, s.shearDisplacement = 1e-3 * K;
  s.friction = std::tan(phi * base::kPi / 180);
  return s;
}

// Sinkages and energies: z = (p / k)^(1/n), p z / (n + 1); the figures are from an independent computation.
const std::vector<Soil> kSoils = {{"LETE sand",
                                   constants(0.793, 102, 5301, 1.3, 31.1, 12),
                                   5665286,
                                   2.40673,
                                   3.23124,
                                   63.759,
                                   197.4,
                                   0.2407,
                                   5.716,
                                   {21.429, 27.008, 29.019, 30.026, 30.630}},
                                  {"dry sand",
                                   constants(1.1, 0.99, 1528.4, 1.04, 28, 25),
                                   1531936,
                                   42.5301,
                                   52.5934,
                                   961.99,
                                   12.29,
                                   3.866,
                                   91.83,
                                   {13.026, 20.062, 23.564, 25.402, 26.507}},
                                  {"Upland sandy loam",
                                   constants(1.1, 74.6, 2080, 3.3, 33.7, 20),
                                   2346429,
                                   28.8576,
                                   35.6857,
                                   652.73,
                                   18.11,
                                   2.623,
                                   62.31,
                                   {19.730, 28.479, 32.321, 34.279, 35.454}},
                                  {"Rubicon sandy loam",
                                   constants(0.66, 6.9, 752, 3.7, 29.8, 20),
                                   776643,
                                   14.4985,
                                   20.6560,
                                   414.87,
                                   32.76,
                                   1.450,
                                   34.43,
                                   {17.431, 25.161, 28.555, 30.285, 31.324}}};

/// Sinkage at which a point of virgin soil carries a pressure, in small steps.
double sinkTo(double pressure, Compaction& place, const Soil& soil, const PressureCurve& curve, Compression& all,
              double from) {
  const double k = soil.constants.modulusAt(kBreadth);
  const double end = base::pow(pressure / k, 1 / soil.constants.exponent);
  constexpr int kSteps = 1000;
  double z = from;
  for (int i = 1; i <= kSteps; ++i) {
    const double next = from + (end - from) * i / kSteps;
    const Compression c = compress(place, soil.constants, curve, k, z, next);
    all.pressure = c.pressure, all.work += c.work, all.loss += c.loss, z = next;
  }
  return z;
}

TEST(Compaction, APlateSinksReboundsAndSinksAgainAsBekkerAndWongHaveIt) {
  for (const Soil& soil : kSoils) {
    SCOPED_TRACE(soil.name);
    const PressureCurve curve(soil.constants.exponent, 0.5);
    const double k = soil.constants.modulusAt(kBreadth);
    EXPECT_NEAR(k, soil.k, 3e-4 * soil.k);
    Compaction place;
    Compression down;
    const double z = sinkTo(kPressure, place, soil, curve, down, 0);
    EXPECT_NEAR(1e3 * z, soil.sinkage, 3e-4 * soil.sinkage);
    EXPECT_NEAR(down.pressure, kPressure, 1e-4 * kPressure) << "interpolation of z^n";
    EXPECT_NEAR(down.work, soil.work, 5e-4 * soil.work);
    EXPECT_NEAR(1e-6 * place.stiffness, soil.stiffness, 1e-3 * soil.stiffness);
    EXPECT_NEAR(1e3 * (place.sinkage - place.rebound()), soil.rebound, 1e-3 * soil.rebound);
    EXPECT_NEAR(place.elastic(down.pressure), soil.held, 1e-3 * soil.held);
    EXPECT_NEAR(down.work, down.loss + place.elastic(down.pressure), 1e-12 * down.work);
    // Unloading and reloading: the same line, no loss, the same sinkage.
    const Compression up = compress(place, soil.constants, curve, k, z, 0);
    EXPECT_EQ(up.pressure, 0);
    EXPECT_NEAR(up.work, -place.elastic(kPressure), 1e-3 * soil.held);
    EXPECT_EQ(up.loss, 0);
    const Compaction rested = place;
    const Compression again = compress(place, soil.constants, curve, k, 0, z);
    EXPECT_NEAR(again.pressure, kPressure, 1e-4 * kPressure) << "the second pass adds no sinkage";
    EXPECT_EQ(again.loss, 0);
    EXPECT_EQ(place.sinkage, rested.sinkage);
    // Beyond it the virgin curve continues.
    Compression on;
    const double deeper = sinkTo(60e3, place, soil, curve, on, z);
    EXPECT_NEAR(1e3 * deeper, soil.deeper, 3e-4 * soil.deeper);
    EXPECT_NEAR(on.pressure, 60e3, 6);
    EXPECT_GT(on.loss, 0);
  }
}

TEST(Compaction, TheEnergyOfAPathIsThatOfItsSteps) {
  const Soil& soil = kSoils[0];
  const PressureCurve curve(soil.constants.exponent, 0.5);
  const double k = soil.constants.modulusAt(kBreadth);
  Compaction once, often;
  const Compression whole = compress(once, soil.constants, curve, k, 0, 0.02);
  Compression sum;
  for (int i = 0; i < 100; ++i) {
    const Compression c = compress(often, soil.constants, curve, k, 2e-4 * i, 2e-4 * (i + 1));
    sum.work += c.work, sum.loss += c.loss;
  }
  EXPECT_NEAR(sum.work, whole.work, 1e-12 * whole.work) << "exact for any step";
  EXPECT_NEAR(sum.loss, whole.loss, 1e-12 * whole.loss);
  EXPECT_NEAR(often.pressure, once.pressure, 1e-9 * once.pressure);
}

TEST(Compaction, LosesNoEnergyBackwardsWhateverTheConstantsAre) {
  SoilConstants soil = kSoils[0].constants;
  soil.unloadingGrowth = 5.03e5; // far softer than virgin soil: the limit applies
  for (const double n : {0.5, 0.793, 1.0, 1.6}) {
    soil.exponent = n;
    const PressureCurve curve(n, 0.5);
    Compaction place;
    double z = 0;
    for (int i = 1; i <= 4000; ++i) {
      const double next = std::max(0.0, 0.03 * i / 4000 + 0.004 * std::sin(0.1 * i));
      const Compression c = compress(place, soil, curve, soil.modulusAt(kBreadth), z, next);
      EXPECT_GE(c.loss, -1e-12) << n << " " << i;
      EXPECT_LE(place.rebound(), place.sinkage);
      EXPECT_GE(place.rebound(), 0) << "never above its initial surface";
      z = next;
    }
  }
}

TEST(Compaction, AStifferLoadBeginsWhereItsCurveMeetsThePresentLine) {
  const Soil& soil = kSoils[0];
  const PressureCurve curve(soil.constants.exponent, 0.5);
  Compaction place;
  compress(place, soil.constants, curve, 5e6, 0, 0.01);
  const Compaction soft = place;
  const double beyond = 0.0101;
  const Compression c = compress(place, soil.constants, curve, 6e6, 0.01, beyond);
  EXPECT_NEAR(c.pressure, soft.pressure + soft.stiffness * (beyond - 0.01), 1e-6 * c.pressure)
      << "on the old line until that meets the stiffer curve";
  EXPECT_EQ(c.loss, 0);
  const Compression further = compress(place, soil.constants, curve, 6e6, beyond, 0.02);
  EXPECT_NEAR(further.pressure, 6e6 * std::pow(0.02, 0.793), 1e-4 * further.pressure);
  // A later, softer unloading does not soften it.
  EXPECT_NEAR(compress(place, soil.constants, curve, 5e6, 0.02, 0.021).pressure, 6e6 * std::pow(0.021, 0.793),
              1e-4 * further.pressure);
}

TEST(Shear, GrowsAsJanosiHasItAndTurnsWithTheSlip) {
  constexpr double K = 0.012;
  const double expected[] = {0.632121, 0.864665, 0.993262, 0.9999546};
  const int multiples[] = {1, 2, 5, 10};
  for (int i = 0; i < 4; ++i) {
    Shear s;
    for (int step = 0; step < 50; ++step) advance(s, 0.6 * multiples[i] * K / 50, 0.8 * multiples[i] * K / 50, K);
    EXPECT_NEAR(std::sqrt(s.square()), expected[i], 1e-6);
    EXPECT_NEAR(s.x / s.y, 0.75, 1e-12);
  }
  // Reversed from full shear: zero after K ln 2.
  Shear back{1, 0};
  advance(back, -K * std::log(2.0), 0, K);
  EXPECT_NEAR(back.x, 0, 1e-15);
  advance(back, -K, 0, K);
  EXPECT_NEAR(back.x, -1 + std::exp(-1.0), 1e-15) << "-1 + 2 exp(-j / K) after the reversal";
  // A rotation by 90 degrees.
  Shear turned{1, 0};
  advance(turned, 0, 2 * K, K);
  EXPECT_NEAR(turned.x, std::exp(-2.0), 1e-15);
  EXPECT_NEAR(turned.y, 1 - std::exp(-2.0), 1e-15);
}

TEST(Shear, LagsBehindACircularSlip) {
  constexpr double K = 0.025, kRadius = 0.1;
  constexpr int kSteps = 20000;
  Shear s;
  double angle = 0;
  for (int i = 0; i < 10 * kSteps; ++i) {
    const double next = 2 * base::kPi * (i + 1) / kSteps;
    advance(s, kRadius * (std::cos(next) - std::cos(angle)), kRadius * (std::sin(next) - std::sin(angle)), K);
    angle = next;
  }
  EXPECT_NEAR(std::sqrt(s.square()), 1 / std::sqrt(1 + K * K / (kRadius * kRadius)), 1e-4);
  const double along = s.y, inward = -s.x; // the slip is along y, the centre is towards -x
  EXPECT_NEAR(std::atan2(-inward, along), std::atan(K / kRadius), 1e-3) << "14 degrees: stress lags the slip";
}

TEST(Shear, WorkIsExactAndItsLossNeverNegative) {
  constexpr double K = 0.02;
  Shear coarse{0.3, -0.4}, fine = coarse;
  const ShearWork whole = advance(coarse, -0.01, 0.004, K);
  ShearWork sum;
  for (int i = 0; i < 100; ++i) {
    const ShearWork w = advance(fine, -1e-4, 4e-5, K);
    EXPECT_GE(w.loss, -1e-18);
    sum.work += w.work, sum.loss += w.loss;
  }
  // Pade's fraction in steps of x = l / K = 0.0054: an error of 100 x^5 / 720 = 6e-13, times K of work.
  EXPECT_NEAR(fine.x, coarse.x, 1e-12);
  EXPECT_NEAR(sum.work, whole.work, 2e-14);
  EXPECT_NEAR(sum.loss, whole.loss, 2e-14);
  // The loss is |s|^2 |dj|: by Simpson's rule over the exact s.
  double loss = 0;
  const double length = std::hypot(0.01, 0.004);
  for (int i = 0; i <= 1000; ++i) {
    Shear s{0.3, -0.4};
    advance(s, -1e-5 * i, 4e-6 * i, K);
    loss += (i == 0 || i == 1000 ? 1 : i % 2 ? 4 : 2) * s.square() * length / 3000;
  }
  EXPECT_NEAR(whole.loss, loss, 1e-10);
}

TEST(Shear, PiecesUnderARigidTrackPullAsWongsIntegral) {
  constexpr double kLength = 1.85;
  constexpr int kPieces = 400;
  const double slips[] = {0.02, 0.05, 0.1, 0.2, 0.5};
  for (const Soil& soil : kSoils) {
    SCOPED_TRACE(soil.name);
    const double K = soil.constants.shearDisplacement;
    const double strength = soil.constants.cohesion + kPressure * soil.constants.friction;
    for (int k = 0; k < 5; ++k) {
      double pull = 0;
      for (int i = 0; i < kPieces; ++i) {
        Shear s;
        advance(s, slips[k] * kLength * (i + 0.5) / kPieces, 0, K);
        pull += strength * s.x * 2 * kBreadth * kLength / kPieces;
      }
      EXPECT_NEAR(1e-3 * pull, soil.traction[k], 1e-3 * soil.traction[k]);
    }
  }
}

} // namespace
} // namespace grouser::scm
