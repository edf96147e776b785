// SPDX-License-Identifier: BSD-3-Clause
// Impact study: references are known closed forms, errors have the expected order.
#include "base/math.hpp"
#include "runs/validation/studies/impact_report.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::studies {
namespace {

using terrain::Precision;

/// Linear law, radius 5 mm, 2600 kg/m3, 1e5 N/m, on a wall at 1 m/s; by hand and by an independent integration.
struct ClosedForm {
  double zeta, durationFree, free, overlap, durationClamped, clamped;
};
constexpr ClosedForm kClosedForms[] = {
    {0, 3.66552223e-4, 1, 1.16677196e-4, 3.66552223e-4, 1},
    {0.05, 3.67011274e-4, 0.85446789, 1.08123827e-4, 3.55324069e-4, 0.85875810},
    {0.1, 3.68398846e-4, 0.72924761, 1.00645793e-4, 3.44906581e-4, 0.74407940},
    {0.2, 3.74110796e-4, 0.52662060, 8.82237034e-5, 3.26154119e-4, 0.57174003},
    {0.3, 3.84251137e-4, 0.37232610, 7.83542281e-5, 3.09716650e-4, 0.45097545},
    {0.5, 4.23258049e-4, 0.16303353, 6.37399375e-5, 2.82172033e-4, 0.29843606},
    {0.70710678118654752, 5.18383125e-4, 0.04321392, 5.31975825e-5, 2.59191563e-4, 0.20787958},
    {0.9, 8.40928473e-4, 0.00152376, 4.59777367e-5, 2.41457967e-4, 0.15528275},
    {1, 0, 0, 4.29231418e-5, 2.33354393e-4, 0.13533528},
    {1.5, 0, 0, 3.20784445e-5, 2.00875634e-4, 0.07558831},
    {2, 0, 0, 2.55010372e-5, 1.77430078e-4, 0.04776873}};

TEST(ImpactReference, IsTheWholeTableOfClosedForms) {
  constexpr double kDigits = 6e-9; // nine are given
  for (const ClosedForm& row : kClosedForms) {
    const auto free = impactReference({ImpactLaw::linearFree, false, row.zeta, 1}).value;
    const auto clamped = impactReference({ImpactLaw::linearClamped, false, row.zeta, 1}).value;
    EXPECT_NEAR(*free[kOverlap] / row.overlap, 1, kDigits) << row.zeta;
    EXPECT_NEAR(*clamped[kOverlap] / row.overlap, 1, kDigits) << row.zeta;
    EXPECT_NEAR(*clamped[kRestitution], row.clamped, kDigits) << row.zeta;
    EXPECT_NEAR(*clamped[kDuration] / row.durationClamped, 1, kDigits) << row.zeta;
    ASSERT_EQ(free[kRestitution].has_value(), row.zeta < 1) << "at zeta >= 1 the free contact never ends";
    if (row.zeta >= 1) continue;
    EXPECT_NEAR(*free[kRestitution], row.free, kDigits) << row.zeta;
    EXPECT_NEAR(*free[kDuration] / row.durationFree, 1, kDigits) << row.zeta;
  }
}

TEST(StudyImpact, StepMeetsTheWholeTableOfClosedForms) {
  constexpr double kSteps = 300;
  for (const ClosedForm& row : kClosedForms)
    for (const bool clamped : {false, true}) {
      if (!clamped && row.zeta == 0.9) continue; // 2.3 contact times for a restitution of 0.0015
      const ImpactCase c{clamped ? ImpactLaw::linearClamped : ImpactLaw::linearFree, false, row.zeta, 1};
      const ImpactPoint p = measureImpact(c, Precision::single, kSteps, {5, 1});
      // First order: at first touch half a step of the dashpot's force is missing or in excess, zeta pi / steps of the
      // speed, times the restitution; errors of durations and overlaps scale alike.
      const double missed = base::kPi / kSteps * (0.05 + row.zeta);
      EXPECT_LT(p.error[kRestitution].worst, missed) << c.name();
      EXPECT_LT(p.error[kOverlap].worst, 2 * missed) << c.name();
      EXPECT_LT(p.error[kDuration].worst, 4 * missed + 1 / kSteps) << c.name(); // zero if there is no contact
    }
}

TEST(StudyImpact, ConvergesAsAnIndependentIntegrationDoes) {
  // zeta 0.2, free: worst restitution error 0.113 ... 0.0018 at 5 ... 200 steps a contact, two digits given.
  const std::vector<ConvergenceRow> rows = convergenceRows(50);
  for (const ConvergenceRow& row : rows) {
    if (std::isnan(row.published)) continue;
    EXPECT_NEAR(row.damped.worst / row.published, 1, 0.03) << row.steps << " steps";
  }
  EXPECT_NEAR(rows[0].elastic.worst, 1.6e-2, 1e-3) << "5 steps, elastic";
  EXPECT_NEAR(rows[1].elastic.worst, 2e-3, 1e-4) << "10 steps, elastic";
  EXPECT_NEAR(rows[3].damped.mean, -0.0048, 4e-4) << "mean bias at 20 steps";
}

TEST(StudyImpact, OrderIsOneWithDampingAndTwoWithout) {
  for (const Precision precision : {Precision::single, Precision::double_})
    for (const bool binary : {false, true})
      for (const ImpactCase& c :
           {ImpactCase{ImpactLaw::linearFree, binary, 0.2, 1}, ImpactCase{ImpactLaw::linearClamped, binary, 0.2, 1},
            ImpactCase{ImpactLaw::linearClamped, binary, 0, 1}, ImpactCase{ImpactLaw::hertzFree, binary, 0, 1},
            ImpactCase{ImpactLaw::hertzClamped, binary, 0.233, 1}}) {
        ImpactSeries series{c, precision, {}};
        for (const double steps : {14.3, 28.6, 57.2, 114.4})
          series.points.push_back(measureImpact(c, precision, steps, {10, 4}));
        const ImpactReference reference = impactReference(c);
        for (int q = 0; q < kImpactQuantities; ++q) {
          if (!reference.value[static_cast<std::size_t>(q)]) continue;
          const support::LineFit order = measuredOrder(series, q);
          ASSERT_TRUE(order.hasError()) << c.name();
          // Four points with different phases: 0.25, and more if the soft start of a Hertz contact reduces the error.
          const bool soft = !c.isLinear() && c.damping == 0 && q == kRestitution;
          EXPECT_GT(order.slope, expectedOrder(c, q) - 0.25) << c.name() << ", " << impactQuantityName(q);
          EXPECT_LT(order.slope, expectedOrder(c, q) + (soft ? 3 : 0.25)) << c.name() << ", " << impactQuantityName(q);
        }
      }
}

TEST(StudyImpact, RestitutionDoesNotDependOnTheSpeed) {
  for (const ImpactLaw law : {ImpactLaw::linearFree, ImpactLaw::linearClamped, ImpactLaw::hertzClamped})
    for (const Precision precision : {Precision::single, Precision::double_}) {
      const double atOne = measureImpact({law, false, 0.2, 1}, precision, 49.35, {5, 1}).measured[kRestitution];
      for (const double speed : {1e-3, 1e-2, 0.1, 10.0})
        // At 1 mm/s the overlap is 2000 units of length: plus or minus one unit at the start and end of contact.
        EXPECT_NEAR(measureImpact({law, false, 0.2, speed}, precision, 49.35, {5, 1}).measured[kRestitution], atOne,
                    speed < 0.01 ? 5e-4 : 5e-5)
            << ImpactCase{law, false, 0.2, speed}.name() << " at " << speed;
    }
}

TEST(StudyImpact, CheapestStepIsTheCoarsestThatAllFinerOnesConfirm) {
  ImpactSeries series{{ImpactLaw::linearFree, false, 0.2, 1}, Precision::single, {}};
  const double worst[] = {0.2, 0.005, 0.05, 0.009, 0.004};
  for (int k = 0; k < 5; ++k) {
    ImpactPoint p;
    p.steps = 10 * (k + 1), p.error[kRestitution].worst = worst[k];
    series.points.push_back(p);
  }
  ASSERT_NE(cheapestImpact(series, kRestitution, 0.01), nullptr);
  EXPECT_EQ(cheapestImpact(series, kRestitution, 0.01)->steps, 40) << "not the accidental agreement at 20";
  EXPECT_EQ(cheapestImpact(series, kRestitution, 0.1)->steps, 20);
  EXPECT_EQ(cheapestImpact(series, kRestitution, 0.001), nullptr);
}

} // namespace
} // namespace grouser::studies
