// SPDX-License-Identifier: BSD-3-Clause
// Control of the complementarity iterations: stopping, rejected trials, and the relaxation.
#include "terrain/impulse_control.hpp"

#include "contact/impulse_cone.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain {
namespace {

/// Sums of an evaluation with the residual `worst` [m/s] and a curvature of `curvature` times the length.
IterationSums sums(double worst, double curvature = 0.5, double against = -1) {
  return {curvature, 1, against, worst * worst, 1, worst};
}

ImpulseControl<float> control() {
  ImpulseControl<float> c;
  c.residual = 1e-3, c.maxIterations = 500;
  return c;
}

TEST(ImpulseControl, StopsAtOnceWhereTheFirstImpulsesSatisfyTheTolerance) {
  ImpulseControl<float> c = control();
  EXPECT_TRUE(c.endsWith(sums(1e-3)));
  c.take(sums(1e-3));
  EXPECT_TRUE(c.done);
  EXPECT_EQ(c.iterations, 0);
  EXPECT_EQ(c.now, 0);
}

TEST(ImpulseControl, AcceptedTrialsPermuteTheBuffers) {
  ImpulseControl<float> c = control();
  for (int k = 0; k < 10; ++k) {
    const int now = c.now, tried = c.tried;
    c.take(sums(1));
    EXPECT_EQ(c.before, now);
    EXPECT_EQ(c.now, tried);
    EXPECT_EQ(c.now + c.before + c.tried, 3);
    EXPECT_NE(c.now, c.tried);
    EXPECT_EQ(c.iterations, k + 1);
  }
  EXPECT_GT(c.ahead, 0);
  EXPECT_LT(c.tau, 1);
  c.take(sums(1, 0.5, 1)); // a step against the last change restarts the extrapolation
  EXPECT_EQ(c.ahead, 0);
}

TEST(ImpulseControl, HighCurvatureRepeatsTheTrialWithAShorterStep) {
  ImpulseControl<float> c = control();
  c.take(sums(1));
  const ImpulseControl<float> before = c;
  c.take(sums(1, 1.5));
  EXPECT_EQ(c.tau, 2 * before.tau);
  EXPECT_EQ(c.iterations, before.iterations);
  EXPECT_EQ(c.now, before.now);
  EXPECT_EQ(c.before, before.before);
  EXPECT_EQ(c.tried, before.tried);
  EXPECT_EQ(c.evaluations, before.evaluations + 1);
}

TEST(ImpulseControl, CurvatureWithinItsRoundingErrorIsAccepted) {
  ImpulseControl<float> c = control();
  c.resolution = 0.1;
  c.take(sums(1, 1.05));
  EXPECT_EQ(c.iterations, 1);
  c.take(sums(1, 1.2));
  EXPECT_EQ(c.iterations, 1);
}

TEST(ImpulseControl, TheRelaxationStartsFromTheCurrentImpulses) {
  ImpulseControl<float> c = control();
  int steps = 0;
  for (; !c.relaxed && steps < 200; ++steps) c.take(sums(1, 0));
  EXPECT_EQ(steps, ImpulseControl<float>::kPatience + 2);
  EXPECT_EQ(c.before, c.now);
  EXPECT_NE(c.tried, c.now);
  EXPECT_EQ(c.ahead, 0);
  EXPECT_FALSE(c.done);
  c.maxIterations = c.iterations;
  c.take(sums(1));
  EXPECT_FALSE(c.done) << "Coulomb's law judges its result";
  EXPECT_FALSE(c.associated);
  const int now = c.now, iterations = c.iterations;
  c.take(sums(7));
  EXPECT_TRUE(c.done);
  EXPECT_EQ(c.last.worst, 7);
  EXPECT_TRUE(c.relaxed);
  EXPECT_EQ(c.now, now);
  EXPECT_EQ(c.iterations, iterations);
}

TEST(ImpulseControl, WhatRoundingHidesIsNotAskedFor) {
  ImpulseControl<float> c = control();
  IterationSums some = sums(2e-3);
  some.rounding = 3e-3;
  EXPECT_EQ(c.tolerance(some), 3e-3);
  c.take(some);
  EXPECT_TRUE(c.done);
  c = control();
  some.rounding = 0.5e-3;
  EXPECT_EQ(c.tolerance(some), 1e-3);
  c.take(some);
  EXPECT_FALSE(c.done);
}

TEST(ImpulseControl, TheStepIsTakenFromTheExtrapolatedIterate) {
  ImpulseControl<float> c = control();
  c.now = 1, c.before = 0, c.tried = 2, c.ahead = 0.5f;
  const double of[] = {1, 3, 7};
  EXPECT_EQ(c.stepOf([&](int k) { return of[k]; }), 7 - (3 + 0.5 * (3 - 1)));
}

TEST(ImpulseCone, TinyAndOrdinaryImpulsesAreCutAlike) {
  for (const float size : {1e-25f, 1e-3f, 1e18f}) {
    const contact::Impulse<float> cut =
        contact::cutToCoulomb(contact::Impulse<float>{{3 * size, 4 * size, 10 * size}, {}}, {0, 0, 1}, {0.25f, 0});
    EXPECT_NEAR(cut.linear.x / size, 1.5, 1e-6);
    EXPECT_NEAR(cut.linear.y / size, 2, 1e-6);
    EXPECT_NEAR(cut.linear.z / size, 10, 1e-5);
    EXPECT_NEAR(contact::lengthOf(base::Vec3<float>{3 * size, 4 * size, 0}) / size, 5, 1e-5);
  }
}

} // namespace
} // namespace grouser::terrain
