// SPDX-License-Identifier: BSD-3-Clause
#include "benchmarks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

namespace grouser::multibody::test {
namespace {

/// Measures the order from the errors at two steps and reports both.
double measuredOrder(const char* what, int order, double dt, double ratio, const std::function<double(double)>& error) {
  const double coarse = error(dt), fine = error(dt / ratio);
  const double measured = std::log(coarse / fine) / std::log(ratio);
  std::printf("%s, order %d: error %.3e at dt = %g s, %.3e at %g s, measured order %.2f\n", what, order, coarse, dt,
              fine, dt / ratio, measured);
  return measured;
}

TEST(Rattle, PendulumConvergesWithTheOrderOfTheScheme) {
  // Elliptic functions: theta = 2 asin(k sn(K - sqrt(g) t)), k = sin 45 degrees.
  const Vec3d at10{.2750874625761169, 0, -.9614192050991251};
  for (const int order : {2, 4, 6, 8}) {
    const double dt = order == 2 ? 2e-3 : order == 4 ? 2e-2 : order == 6 ? 4e-2 : 1e-1;
    const double measured = measuredOrder("pendulum on a massless rod, 10 s", order, dt, 2, [&](double h) {
      Mechanism p = pendulumOnARod();
      run(p, rattle(order), h, 10);
      return length(p.state.pose[0].position - at10);
    });
    EXPECT_NEAR(measured, order, order == 8 ? 1.0 : 0.2);
  }
}

TEST(Rattle, PointMassHoldsNineDigitsOverAHundredSeconds) {
  Mechanism p = pendulumOnARod();
  run(p, rattle(8), 0.02, 100);
  const double error = length(p.state.pose[0].position - Vec3d{.1815133514270314, 0, -.9833884803340575});
  std::printf("pendulum after 100 s: error %.3e m\n", error);
  EXPECT_LT(error, 1e-9);
}

TEST(Rattle, PointMassHoldsEightDigitsOverTwoThousandSeconds) {
  // 997 oscillations; the energy must not drift: each step's position constraint is exact to round-off.
  Mechanism p = pendulumOnARod();
  run(p, rattle(8), 0.02, 2000);
  const double error = length(p.state.pose[0].position - Vec3d{-.8146030685890322, 0, -.5800188278369355});
  std::printf("pendulum after 2000 s: error %.3e m, energy %.2e J\n", error, energy(p));
  EXPECT_LT(error, 1e-8);
  EXPECT_LT(std::fabs(energy(p)), 1e-10);
}

TEST(Rattle, RodTensionIsThatOfTheExactMotion) {
  // 3 m g cos(theta) from horizontal release; the reading has only the error of the state.
  Mechanism p = pendulumOnARod();
  Solver solver(p.model, rattle(8));
  double worst = 0, most = 0;
  for (int i = 0; i < 400; ++i) {
    solver.step(p.state, p.loads, 0.01);
    const double cosine = -p.state.pose[0].position.z;
    worst = std::max(worst, std::fabs(length(p.state.joint[0].force) - 3 * 9.81 * cosine));
    most = std::max(most, length(p.state.joint[0].force));
  }
  std::printf("rod tension: off by at most %.2e N, largest %.4f N\n", worst, most);
  EXPECT_LT(worst, 1e-9);
  EXPECT_NEAR(most, 29.43, 1e-2);
}

TEST(Rattle, FourBarsPassTheirSingularPositionWithTheOrderOfTheScheme) {
  struct FourBars {
    int n;
    double t, x, z;
  };
  // One degree of freedom in closed form: [(N+1)/3 + N] phi'' = g [(N+1)/2 + N] sin(phi).
  for (const FourBars& c :
       {FourBars{2, 10, .328458111541, .944518538179}, FourBars{40, 5, -.540190050676, -.841543052464}})
    for (const int order : {2, 4}) {
      int singular = 0;
      const double measured =
          measuredOrder(c.n == 2 ? "2 four-bars, 10 s" : "40 four-bars, 5 s", order, 0.01, 2, [&](double h) {
            Mechanism m = fourBars(c.n);
            m.loads.gravity = {0, 0, -9.81};
            Solver solver(m.model, rattle(order));
            EXPECT_EQ(solver.degreesOfFreedom(), 1);
            const int steps = static_cast<int>(std::lround(c.t / h));
            for (int i = 0; i < steps; ++i) {
              solver.step(m.state, m.loads, h);
              singular += solver.lastStep().singularRows;
              EXPECT_LT(solver.lastStep().maxPositionError, 1e-9);
            }
            return length(tipOf(m) - Vec3d{c.x, 0, c.z});
          });
      EXPECT_NEAR(measured, order, 0.3) << singular << " singular rows on the way";
    }
}

TEST(Rattle, AndrewsMechanismConvergesToTheReference) {
  // beta at 0.03 s from an index-1 formulation with DOP853, self-converged to 3e-12 (the published digits deviate
  // by 1.4e-9).
  const double reference = 15.810771195153;
  for (const int order : {2, 4, 8}) {
    const double dt = order == 2 ? 4e-6 : order == 4 ? 2e-5 : 4e-5;
    double error = 0;
    const double measured = measuredOrder("Andrews' mechanism, 0.03 s", order, dt, 2, [&](double h) {
      Mechanism a = Andrews::make();
      const double start = energy(a), beta0 = Andrews::beta(a);
      run(a, rattle(order), h, 0.03);
      // The motor's work is known: torque times the crank's angle.
      const double balance = energy(a) - start - Andrews::torque * (Andrews::beta(a) - beta0);
      EXPECT_LT(std::fabs(balance), order == 2 ? 1e-5 : order == 4 ? 1e-8 : 1e-11);
      error = std::fabs(Andrews::beta(a) - reference);
      return error;
    });
    // Order 8 is at round-off and at the reference's own 4e-12 with either step.
    if (order == 8)
      EXPECT_LT(error, 2e-11);
    else
      EXPECT_NEAR(measured, order, 0.3);
  }
}

TEST(Rattle, FreeTopFollowsTheClosedForm) {
  const Quat at10{.462545440555, -.314335145145, .049429631279, .827527548484};
  for (const int order : {2, 4, 6}) {
    const double measured = measuredOrder("free top, 10 s", order,
                                          order == 2   ? 1e-2
                                          : order == 4 ? 4e-2
                                                       : 0.2,
                                          2, [&](double h) {
                                            Mechanism t = freeTop({1, 1, 1});
                                            const Vec3d before = totals(t.model, t.state, t.loads).angularMomentum;
                                            run(t, rattle(order), h, 10);
                                            const Vec3d after = totals(t.model, t.state, t.loads).angularMomentum;
                                            EXPECT_EQ(after, before); // without torque no change: bitwise equal
                                            return attitudeError(t.state.pose[0].orientation, at10);
                                          });
    EXPECT_NEAR(measured, order, 0.2);
  }
}

} // namespace
} // namespace grouser::multibody::test
