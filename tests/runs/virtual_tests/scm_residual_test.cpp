// SPDX-License-Identifier: BSD-3-Clause
// Residuals of curves with known model error and scatter.
#include "runs/virtual_tests/scm_fit.hpp"
#include "runs/virtual_tests/scm_residual.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace grouser::virtual_tests {
namespace {

/// k z^0.8 to 100 kPa, measured with a deviation that depends on the position along the curve.
FittedCurve curve(const std::function<double(double)>& deviation, int points = 200) {
  FittedCurve c{"a test", {}, {}, {}};
  for (int i = 1; i <= points; ++i) {
    const double share = static_cast<double>(i) / points;
    c.way.push_back(0.02 * share), c.fitted.push_back(100e3 * std::pow(share, 0.8));
    c.measured.push_back(c.fitted.back() * (1 + deviation(share)));
  }
  return c;
}

TEST(ScmResidual, ACurveOfTheModelHasNone) {
  const TestResidual r = residualOf(curve([](double) { return 0; }));
  EXPECT_NEAR(r.rms, 0, 1e-14);
  EXPECT_NEAR(r.largest, 0, 1e-14);
}

TEST(ScmResidual, SmallStressesDoNotCount) {
  // A tenth of 90 kPa is reached at 0.05 of the travel.
  const TestResidual r = residualOf(curve([](double s) { return s < 0.05 ? -0.9 : s > 0.5 ? -0.1 : 0.02; }));
  EXPECT_NEAR(r.largest, -0.1, 1e-12);
  EXPECT_NEAR(r.largestAt, 0.0101, 1e-9);
  EXPECT_EQ(r.points, 191);
  EXPECT_NEAR(r.rms, std::sqrt((100 * 0.01 + 91 * 0.0004) / 191), 1e-12);
}

TEST(ScmResidual, ScatterOfSeedsIsNoModelError) {
  std::vector<FittedCurve> tests;
  for (const double shift : {-0.1, 0.0, 0.1}) tests.push_back(curve([shift](double) { return shift; }));
  const GroupResidual r = residualOf(tests);
  EXPECT_NEAR(r.scatter, 0.1, 1e-3) << "standard deviation";
  EXPECT_NEAR(r.model, 0, 1e-12);
  EXPECT_NEAR(r.rms, 0.1 * std::sqrt(2.0 / 3), 1e-3);
  EXPECT_NEAR(std::fabs(r.largest), 0.1, 1e-9);
}

TEST(ScmResidual, ABendThatAllTestsShareIsModelError) {
  std::vector<FittedCurve> tests;
  for (const double shift : {-0.06, 0.0, 0.06})
    tests.push_back(curve([shift](double s) { return shift + (s > 0.5 ? 0.1 : -0.1); }));
  const GroupResidual r = residualOf(tests);
  // The mean curve deviates by 0.1 everywhere; a third of the variance is subtracted from its square.
  EXPECT_NEAR(r.model, std::sqrt(0.01 - 0.0036 / 3), 1e-3);
  EXPECT_NEAR(r.scatter, 0.06, 1e-3);
}

TEST(ScmResidual, OneTestHasNoScatter) {
  const GroupResidual r = residualOf(std::vector{curve([](double) { return 0.05; })});
  EXPECT_TRUE(std::isnan(r.scatter));
  EXPECT_NEAR(r.model, 0.05, 1e-12);
}

/// Loading to 60 kPa at 6 mm, and unloading at 200 MPa/m.
TEST(ElasticRatio, IsTheUnloadingSlopeOverTheSecant) {
  jobs::Table run;
  run.names = kSinkageColumns;
  const auto add = [&](double phase, double sinkage, double pressure) {
    run.rows.push_back({phase, sinkage, pressure, 0.4, 1000, 1, 1, 1, 1});
  };
  for (int i = 1; i <= 60; ++i) add(0, 0.001 + 1e-4 * i, 60e3 * i / 60.0);
  for (int i = 0; i <= 30; ++i) add(1, 0.007 - 1e-5 * i, 60e3 - 2e3 * i);
  const double from = unloadingOf(run).from; // mean of the last rows
  EXPECT_NEAR(elasticRatioOf(run, 0.001, 0.8), 200e6 * 0.006 / from, 1e-3);
  EXPECT_NEAR(elasticRatioOf(run, 0.001, 1.25), 200e6 * 0.006 / from / 1.25, 1e-3);
}

} // namespace
} // namespace grouser::virtual_tests
