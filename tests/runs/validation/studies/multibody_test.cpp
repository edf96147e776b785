// SPDX-License-Identifier: BSD-3-Clause
// Multibody study: references, and accuracy of the solver.
#include "runs/validation/studies/elliptic.hpp"
#include "runs/validation/studies/multibody.hpp"
#include "runs/validation/studies/report.hpp"
#include "runs/validation/studies/stability.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grouser::studies {
namespace {

const StudyCase& caseOf(const std::vector<StudyCase>& cases, const std::string& name) {
  return *std::find_if(cases.begin(), cases.end(), [&](const StudyCase& c) { return c.name == name; });
}

TEST(Elliptic, QuarterPeriodIsTheTabulatedOne) {
  EXPECT_NEAR(quarterPeriod(0), 1.5707963267948966, 1e-15);
  EXPECT_NEAR(quarterPeriod(std::sqrt(0.5)), 1.8540746773013719, 1e-15);
}

TEST(Elliptic, FunctionsMeetTheirIdentitiesAndAValue) {
  const double k = 0.8;
  for (const double u : {-3.0, 0.1, 1.0, 7.0, 1000.0}) {
    const Jacobi j = jacobi(u, k);
    EXPECT_NEAR(j.sn * j.sn + j.cn * j.cn, 1, 1e-15);
    EXPECT_NEAR(j.dn * j.dn + k * k * j.sn * j.sn, 1, 1e-15);
  }
  // Half of the quarter period: sn^2 = 1 / (1 + k').
  EXPECT_NEAR(jacobi(0.5 * quarterPeriod(k), k).sn, 1 / std::sqrt(1 + 0.6), 1e-15);
}

TEST(StudyReference, PendulumAfter2000SecondsIsWhereTheLiteratureHasIt) {
  const auto cases = studyCases();
  const std::vector<double> at = caseOf(cases, "pendulum2000").reference(2000);
  // 16 digits of the closed form; 845 periods lose three.
  EXPECT_NEAR(at[0], -0.8146030685890322, 1e-12);
  EXPECT_NEAR(at[1], -0.5800188278369355, 1e-12);
}

TEST(StudyReference, FourBarsAreWhereTheLiteratureHasThem) {
  const auto cases = studyCases();
  const std::vector<double> two = caseOf(cases, "fourbar2").reference(10),
                            forty = caseOf(cases, "fourbar40").reference(20);
  const double expectedTwo[] = {0.328458111541, 0.944518538179, 1.423051470207, -0.494868845487};
  const double expectedForty[] = {0.410901153763, 0.911679900972, 1.566785371909, -0.706162235594};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(two[i], expectedTwo[i], 1e-11) << i; // twelve digits are given
    EXPECT_NEAR(forty[i], expectedForty[i], 1e-11) << i;
  }
}

TEST(StudyReference, FilesHoldARowForEverySample) {
  for (const StudyCase& c : studyCases())
    for (double t = c.sample; t < c.end + 0.5 * c.sample && t < 20.5; t += c.sample)
      ASSERT_EQ(c.reference(std::round(t / c.sample) * c.sample).size(), c.probes.size()) << c.name;
}

class StudyAccuracy : public ::testing::TestWithParam<const char*> {};

/// RATTLE has order 2; the second of two steps, a quarter of the first, shows it within a tenth.
TEST_P(StudyAccuracy, ErrorFallsWithTheSquareOfTheStep) {
  const auto cases = studyCases();
  const std::vector<StudyPoint> points = studyOne(caseOf(cases, GetParam()), studyIntegrators()[1], 3, 60);
  ASSERT_TRUE(points[2].error) << points[2].failure;
  EXPECT_NEAR(points[2].order, 2, 0.1);
  EXPECT_LT(*points[2].error, 0.02);
  // Joints close to the tolerance of 1e-13, and to round-off in velocity.
  EXPECT_LE(points[2].positionDrift, 1e-13);
  EXPECT_LT(points[2].velocityDrift, 1e-9);
}
INSTANTIATE_TEST_SUITE_P(All, StudyAccuracy,
                         ::testing::Values("pendulum", "revolute", "fixed", "prismatic", "torsion", "andrews",
                                           "top_free", "ring46"),
                         [](const auto& claim) { return std::string(claim.param); });

/// Imposed motions and constant accelerations: round-off only.
TEST(StudyAccuracy, RattleIsExactWhereTheMotionIsImposedOrAParabola) {
  const auto cases = studyCases();
  for (const char* name : {"universal", "slidercrank", "cylindrical", "gears"}) {
    const std::vector<StudyPoint> points = studyOne(caseOf(cases, name), studyIntegrators()[1], 2, 60);
    ASSERT_TRUE(points[1].error) << points[1].failure;
    EXPECT_LT(*points[1].error, 1e-10) << name;
  }
}

TEST(StudyAccuracy, SymplecticEulerHasOrderOne) {
  const auto cases = studyCases();
  const std::vector<StudyPoint> points = studyOne(caseOf(cases, "andrews"), studyIntegrators()[0], 4, 60);
  ASSERT_TRUE(points[3].error) << points[3].failure;
  EXPECT_NEAR(points[3].order, 1, 0.1);
}

TEST(StudyAccuracy, ReactionsAreThoseOfTheClosedForm) {
  for (const ReactionCase& r : reactionCases()) {
    const ReactionResult result = measureReaction(r, studyIntegrators()[1]);
    ASSERT_TRUE(result.mean) << r.name << ": " << result.failure;
    // The strand's reference has eight digits; the ring's step turns it by 0.01 rad: (0.01)^2 / 12 of the force.
    EXPECT_NEAR(*result.mean / r.exact, 1, 2e-5) << r.name << ": " << r.title;
  }
}

TEST(StudyStability, IsAsPredicted) {
  const std::vector<StabilityPoint> points = studyStability();
  for (const StabilityPoint& p : points) {
    EXPECT_TRUE(p.stable || !p.predicted) << p.what << ", " << p.integrator << " at " << p.step << " s";
    // Rejected only above the limit; far above it nothing is stable.
    EXPECT_FALSE(p.refused && p.predicted) << p.what << " at " << p.step;
    EXPECT_FALSE(p.stable && p.step > 2 * p.limit) << p.what << " at " << p.step;
  }
  EXPECT_GT(points.size(), 150u);
}

} // namespace
} // namespace grouser::studies
