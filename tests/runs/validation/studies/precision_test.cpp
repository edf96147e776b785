// SPDX-License-Identifier: BSD-3-Clause
// Contact detection in several arithmetics, and divergence between runs of both precisions.
#include "runs/validation/studies/drift.hpp"
#include "runs/validation/studies/touch.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::studies {
namespace {

constexpr TouchArithmetic kAll[] = {kFloatFromOrigin, kFloatFromCell, kFloatDifference, kDoubleMetres};

struct Pair {
  base::Position a, b;
};
/// Two spheres at `place`, side by side along x, `gap` metres apart.
Pair pairWithGap(const base::Vec3d& place, double gap) {
  const base::PositionScale scale = studyBoxScale();
  const base::Vec3l u = base::toUnits(scale.fromMetres(place));
  const auto apart = studyBoxDiameter() + static_cast<std::int64_t>(std::floor(gap * scale.perMetre + 0.5));
  return {base::fromUnits(u), base::fromUnits({u.x + apart, u.y, u.z})};
}

TEST(TouchArithmetic, ClearCasesAreDecidedAlikeByAll) {
  for (const double gap : {-1e-3, -1e-5, 1e-5, 1e-3})
    for (const base::Vec3d& place : {base::Vec3d{0.01, 0.02, 0.03}, base::Vec3d{7.3, -4.1, 0.2}}) {
      const Pair pair = pairWithGap(place, gap);
      EXPECT_EQ(touchesExactly(pair.a, pair.b, studyBoxDiameter()), gap < 0);
      for (const TouchArithmetic arithmetic : kAll)
        EXPECT_EQ(touchesIn(arithmetic, pair.a, pair.b, studyBoxScale(), studyBoxDiameter()), gap < 0)
            << touchArithmeticName(arithmetic) << ", gap " << gap;
    }
}

TEST(TouchArithmetic, FloatFromTheOriginCannotTellAPairWithinANanometre) {
  // At 7 m a float has a resolution of 2.4e-7 m: pairs with gaps of 1e-9 m and overlaps of 1e-9 m are rounded alike, so
  // that one of them is misclassified at any position. Double represents both exactly.
  TouchCounts counts;
  constexpr int kPlaces = 50;
  for (int k = 0; k < kPlaces; ++k)
    for (const double gap : {-1e-9, 1e-9}) {
      const Pair pair = pairWithGap({7.0 + 1.37e-3 * k, 3.1, 0.2}, gap);
      counts.add(pair.a, pair.b, studyBoxScale(), studyBoxDiameter());
    }
  EXPECT_EQ(counts.pairs, 2 * kPlaces);
  EXPECT_EQ(counts.touching, kPlaces);
  EXPECT_GE(counts.wrong[kFloatFromOrigin].count(), kPlaces - 2) << "except at a rounding border between the two";
  EXPECT_EQ(counts.wrong[kDoubleMetres].count(), 0);
  EXPECT_NEAR(counts.wrong[kFloatFromOrigin].widest, 1e-9, 0.3e-9) << "positions are whole units of 4.7e-10 m";
  EXPECT_NEAR(counts.nearest, 1e-9, 0.3e-9);
}

TEST(TouchArithmetic, ErrorsAreAsWideAsTheRoundingOfPositions) {
  const double unit = studyBoxScale().unit;
  for (int k = 0; k < 400; ++k)
    for (int gap = -40; gap <= 40; ++gap) {
      const Pair pair = pairWithGap({-6.5 + 0.0313 * k, 2.9, 0.2}, gap * unit);
      const bool exact = touchesExactly(pair.a, pair.b, studyBoxDiameter());
      const auto agrees = [&](TouchArithmetic arithmetic) {
        return touchesIn(arithmetic, pair.a, pair.b, studyBoxScale(), studyBoxDiameter()) == exact;
      };
      // A float of 0.054 to 0.11 m has a resolution of 3.7e-9 m; two and the diameter have three times that: 24 units
      EXPECT_TRUE(std::abs(gap) <= 24 || agrees(kFloatFromCell)) << gap;
      // The square of a difference up to 2^27 units in float: half an ulp of it and of the diameter's, 2^-24.
      EXPECT_TRUE(std::abs(gap) <= 16 || agrees(kFloatDifference)) << gap;
      EXPECT_TRUE(agrees(kDoubleMetres)) << gap;
    }
}

TEST(StudyTouch, StepsOfBothPrecisionsFindTheSameContacts) {
  TouchStudy study;
  study.grains = 1000, study.configurations = 6, study.every = 1000, study.threads = 1;
  int done = 0;
  const auto all = studyTouch(study, [&done](const TouchConfiguration&) { ++done; });
  ASSERT_EQ(done, 6);
  std::int64_t touching = 0;
  for (const TouchConfiguration& c : all) {
    EXPECT_EQ(c.grainListsDiffer, 0) << "the step compares integers";
    EXPECT_EQ(c.wallListsDiffer, 0) << "walls are compared in double, with a radius that is a float in single";
    EXPECT_GT(c.counts.pairs, c.counts.touching);
    EXPECT_EQ(c.counts.wrong[kDoubleMetres].count(), 0);
    touching += c.counts.touching;
  }
  EXPECT_GT(touching, 1000) << "there are contacts to detect";
  EXPECT_GT(all[3].changed, 0.05) << "and others in the next configuration";
}

TEST(StudyDrift, NeighbouringRunsOfAGasPartAtTheRateOfItsCollisions) {
  DriftStudy study;
  study.grains = 125, study.gasTime = 0.6, study.bedTime = 0.02, study.threads = 1;
  const std::vector<Drift> drifts = studyDrift(study, [](double, const std::string&) {});
  ASSERT_EQ(drifts.size(), 4u);
  for (std::size_t k = 0; k < 2; ++k) { // single against double, double against double displaced by a unit
    const Drift& d = drifts[k];
    EXPECT_LT(d.samples.front().rms, 1e-9) << "one unit is 4.7e-10 m";
    EXPECT_GT(d.samples.back().rms, 1e3 * d.samples.front().rms) << "collisions of spheres amplify perturbations";
    // A collision multiplies a distance by about the free path over the radius: several times, not once, not a hundred
    // times.
    const double factor = std::exp(d.growth.slope * d.collisionTime);
    EXPECT_GT(factor, 1.5) << d.pair;
    EXPECT_LT(factor, 20) << d.pair;
  }
}

TEST(StudyDrift, RowsOfManyRunsHaveTheirErrors) {
  DriftStudy study;
  study.grains = 100, study.bedTime = 0.1, study.runs = 3, study.threads = 1;
  const std::vector<MacroRow> rows = studyMacroscopic(study, [](double, const std::string&) {});
  ASSERT_EQ(rows.size(), 40u);
  int beyond = 0;
  for (const MacroRow& r : rows) {
    EXPECT_GT(r.single.mean, -1e-12) << r.quantity;
    // Three runs each: four degrees of freedom, of which 0.4 % are beyond six errors by chance.
    beyond += r.error() > 0 && std::fabs(r.bias()) > 6 * r.error();
  }
  EXPECT_LE(beyond, 1);
  EXPECT_NEAR(rows[0].time, 0.01, 1e-9);
}

} // namespace
} // namespace grouser::studies
