// SPDX-License-Identifier: BSD-3-Clause
// Means, errors and medians in tables of studies; load of a shear test.
#include "runs/jobs/estimate.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/validation/studies/collapse.hpp"
#include "runs/validation/studies/shear.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace grouser::studies {
namespace {

TEST(StudyMeans, AreThoseOfTheValuesWithTheErrorOfTheirScatter) {
  // 1, 2, 4, 9: deviations -3, -2, 0, 5 from 4, sum of squares 38; variance 38 / 3, of the mean a quarter of that.
  const jobs::MeanError m = jobs::meanOf({1, 2, 4, 9});
  EXPECT_NEAR(m.mean, 4, 1e-15);
  EXPECT_NEAR(m.error, std::sqrt(38.0 / 3 / 4), 1e-15);
  EXPECT_EQ(jobs::meanOf({7}).mean, 7);
  EXPECT_EQ(jobs::meanOf({7}).error, 0) << "one value has no scatter";
}

TEST(StudyMeans, MedianIsTheMiddleOneOrTheMeanOfTwo) {
  EXPECT_EQ(jobs::medianOf({9, 1, 4}), 4);
  EXPECT_EQ(jobs::medianOf({9, 1, 4, 2}), 3);
  EXPECT_EQ(jobs::medianOf({}), 0);
}

TEST(ValueText, HasNoMoreDigitsThanItsIntervalAllows) {
  EXPECT_EQ(jobs::valueText({0.07294, 0.00903}), "0.0729 +- 0.0090");
  EXPECT_EQ(jobs::valueText({1234567, 21000}), "(1.235 +- 0.021)e6");
  EXPECT_EQ(jobs::valueText({0.5, 7e-10}), "(5.0000000000 +- 0.0000000070)e-1") << "not 0.5 +- 7.0e-10";
  EXPECT_EQ(jobs::valueText({0.25, std::numeric_limits<double>::infinity()}), "0.25000 (no interval)");
  EXPECT_EQ(jobs::percent({0.25, std::numeric_limits<double>::infinity()}), "25.0 % (no interval)");
}

TEST(ValueText, LeavesOutAnIntervalOfRounding) {
  // Seeds equal except for rounding: 1.5e-11 of the value, below the tolerance of 1e-9.
  EXPECT_EQ(jobs::valueText({0.27056, 4e-12}), "0.27056");
  EXPECT_EQ(jobs::valueText({0.27056, 0}), "0.27056");
  EXPECT_EQ(jobs::plusMinus({0.27056, 4e-12}, 4), "0.2706");
  EXPECT_EQ(jobs::plusMinus({0.27056, 4e-3}, 4), "0.2706 +- 0.0040");
  EXPECT_EQ(jobs::percent({0, 0}), "0.0 %");
}

TEST(StudyShear, NormalForceIsThatOfTheLoadAndTheGrainsAbove) {
  const virtual_tests::SampleGrains material;
  ShearBox box;
  box.length = 8, box.depth = 6, box.speed = 0.1, box.travel = 0.05;
  const double stress = 3000, d = material.diameter(), load = stress * box.length * box.width * d * d;
  double normal = 0, shear = 0;
  const std::vector<ShearRow> rows = shearSample(material, box, stress, 1);
  ASSERT_GE(rows.size(), 4u);
  for (const ShearRow& r : rows) normal += r.normal, shear += r.shear;
  normal /= static_cast<double>(rows.size()), shear /= static_cast<double>(rows.size());
  // The grains above the plane weigh a sixth of the load; fast shearing causes oscillations of that size.
  EXPECT_GT(normal, 0.95 * load);
  EXPECT_LT(normal, 1.4 * load);
  EXPECT_GT(shear, 0.1 * load) << "the upper half is held";
  EXPECT_LT(shear, normal);
  for (std::size_t k = 1; k < rows.size(); ++k) EXPECT_GT(rows[k].displacement, rows[k - 1].displacement);
  EXPECT_NEAR(rows.back().displacement, box.travel * box.length * d, 0.05 * box.travel * box.length * d);
  EXPECT_NEAR(rows.back().lid, 0.5 * box.depth * d, 2 * d) << "on its lower face";
}

TEST(StudyCollapse, RunsAsFarWithBothContactMethods) {
  virtual_tests::SampleGrains material;
  material.stiffness = 3e4, material.rollingFriction = 0.1;
  // The same settled column; the state of penalty contacts continues with complementarity contacts.
  const Collapse penalty = collapseColumn(material, 5, 5, 1, 1),
                 solved = collapseColumn(material, 5, 5, 1, 1, scene::ContactMethod::complementarity);
  EXPECT_EQ(solved.grains, penalty.grains);
  EXPECT_EQ(solved.aspect, penalty.aspect);
  EXPECT_TRUE(solved.rests);
  EXPECT_NEAR(solved.runOut, penalty.runOut, 0.4) << "two of five diameters";
  EXPECT_NEAR(solved.height, penalty.height, 0.2);
}

} // namespace
} // namespace grouser::studies
