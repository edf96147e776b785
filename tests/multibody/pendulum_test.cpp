// SPDX-License-Identifier: BSD-3-Clause
#include "mechanisms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace grouser::multibody::test {
namespace {

/// B1: 1 kg at the end of a massless rod of 1 m, released at rest from the horizontal; x right, z up, axis y.
/// The point is a body of inertia 1e-9 kg m2, which changes the period by 5e-10 of itself.
Mechanism pointPendulum() {
  Mechanism p;
  p.model.addBody(makeBody("mass", 1, pointInertia(), {{1, 0, 0}, {}}));
  p.model.addJointAt("pin", JointType::kRevolute, kWorld, 0, frameWithZ({0, 0, 0}, kY));
  p.start();
  return p;
}

double pointPendulumError(double dt) {
  Mechanism p = pointPendulum();
  Solver solver(p.model);
  const int steps = static_cast<int>(std::lround(10 / dt));
  for (int i = 0; i < steps; ++i) {
    solver.step(p.state, p.loads, dt);
    EXPECT_LE(solver.lastStep().maxPositionError, 1e-10);
  }
  // Exact at t = 10 s: theta = 2 asin(k sn(K - sqrt(g) t)), k = sin 45 degrees.
  const Vec3d& x = p.state.pose[0].position;
  return std::sqrt((x.x - .2750874625761169) * (x.x - .2750874625761169) +
                   (x.z + .9614192050991251) * (x.z + .9614192050991251));
}

TEST(MultibodyPendulum, FollowsTheExactSolutionWithOrderOne) {
  const double coarse = pointPendulumError(2e-3), middle = pointPendulumError(1e-3), fine = pointPendulumError(5e-4);
  std::printf("pendulum error at 10 s: %.3e %.3e %.3e m, orders %.3f %.3f\n", coarse, middle, fine,
              std::log2(coarse / middle), std::log2(middle / fine));
  EXPECT_LT(fine, 2e-3); // measured 1.1e-3
  EXPECT_NEAR(std::log2(coarse / middle), 1, 0.1);
  EXPECT_NEAR(std::log2(middle / fine), 1, 0.1);
}

TEST(MultibodyPendulum, RodTensionIsThreeWeightsCosine) {
  // Released from the horizontal: T = 3 m g cos(theta), 29.43 N at the bottom.
  Mechanism p = pointPendulum();
  Solver solver(p.model);
  const double dt = 1e-4;
  double bottom = 0, worst = 0;
  for (int i = 0; i < 23679; ++i) {
    const double height = -p.state.pose[0].position.z; // position of the step's force
    solver.step(p.state, p.loads, dt);
    const double tension = length(p.state.joint[0].force);
    worst = std::max(worst, std::fabs(tension - 3 * 9.81 * height));
    bottom = std::max(bottom, tension);
  }
  EXPECT_NEAR(bottom, 29.43, 0.01);
  // First order: the velocity is half a step late, and tension changes by up to 3 m g |theta'| dt / 2 = 6.5e-3 N.
  EXPECT_LT(worst, 1e-2);
}

TEST(MultibodyPendulum, RodOnRevoluteMatchesReferenceAccelerationAndPeriod) {
  // B6: rod of 4 m, centre of mass at 2 m, 1 kg, J = (0.04, 0.1, 0.1), g = 9.80665, released from the horizontal.
  Mechanism p;
  p.model.addBody(makeBody("rod", 1, Mat3d::diagonal({0.04, 0.1, 0.1}), {{2, 0, 0}, {}}));
  p.model.addJointAt("pin", JointType::kRevolute, kWorld, 0, frameWithZ({0, 0, 0}, kY));
  p.start();
  p.loads.gravity = {0, 0, -9.80665};
  Solver solver(p.model);
  const double dt = 1e-4;
  solver.step(p.state, p.loads, dt);
  EXPECT_NEAR(p.state.joint[0].rate / dt, 4.783731707, 1e-6); // the angle about y grows downwards

  double position1 = 0, height1 = 0, lastRate = p.state.joint[0].rate, period = 0;
  for (int i = 1; i < 50000; ++i) {
    solver.step(p.state, p.loads, dt);
    if (i + 1 == 10000) position1 = p.state.pose[0].position.x, height1 = p.state.pose[0].position.z;
    const double rate = p.state.joint[0].rate;
    // Rates refer to the middles of the steps: the rate changes from negative to positive after one period.
    if (lastRate < 0 && rate >= 0) period = p.state.time - dt / 2 - dt * rate / (rate - lastRate);
    lastRate = rate;
  }
  // Order one: the start is a half-step impulse too strong, a shift of dt/2 in time.
  EXPECT_NEAR(period, 3.390812742, dt);
  EXPECT_NEAR(position1, -.8923814855, 5e-4);
  EXPECT_NEAR(height1, -1.789875773, 5e-4);
  EXPECT_NEAR(p.state.pose[0].position.x, -1.999683869, 5e-4);
}

TEST(MultibodyPendulum, EnergyHasNoSecularLoss) {
  Mechanism p = pointPendulum();
  Solver solver(p.model);
  const auto energy = [&] {
    const Totals t = totals(p.model, p.state, p.loads);
    return t.kinetic + t.gravity;
  };
  const double dt = 1e-3;
  double early = 0, late = 0;
  for (int i = 0; i < 100000; ++i) {
    solver.step(p.state, p.loads, dt);
    if (i < 2368) early = std::max(early, std::fabs(energy()));
    if (i >= 100000 - 2368) late = std::max(late, std::fabs(energy()));
  }
  // The energy of staggered states oscillates by m g v dt / 2 = 0.022 J; over 42 periods it must not grow.
  EXPECT_LT(early, 0.03);
  EXPECT_NEAR(late, early, 2e-4);
}

TEST(MultibodyPendulum, LedgerClosesWithTheStep) {
  // Kinetic energy = start + works; the work of each impulse uses the mean of the rates before and after it.
  Mechanism p = pointPendulum();
  Solver solver(p.model);
  const auto residual = [&](double dt) {
    p.start();
    for (double t = 0; t < 2; t += dt) solver.step(p.state, p.loads, dt);
    return std::fabs(totals(p.model, p.state, p.loads).kinetic - p.state.ledger.gravityWork);
  };
  const double coarse = residual(1e-3), fine = residual(5e-4);
  std::printf("ledger residual: %.3e J at 1 ms, %.3e J at 0.5 ms\n", coarse, fine);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_LT(fine, 0.3 * coarse); // measured order two: a quarter
}

} // namespace
} // namespace grouser::multibody::test
