// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "mechanisms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace grouser::multibody::test {
namespace {

const Mat3d kSprocketInertia = Mat3d::diagonal({0.4, 0.7, 0.4});

TEST(MultibodyDrive, TorqueIsInertiaTimesAccelerationPlusLoad) {
  Mechanism p;
  p.model.addBody(makeBody("sprocket", 22, kSprocketInertia, {}));
  p.model.addJointAt("axle", JointType::kRevolute, kWorld, 0, frameWithZ({}, kY), 0.5);
  p.model.addDrive({"motor", 0, 0, true});
  p.start();
  Solver solver(p.model);
  p.loads.external[0].torque = {0, -40, 0};
  const double dt = 1e-3, acceleration = 3;
  for (int i = 1; i <= 1000; ++i) {
    p.loads.drives[0].speed = acceleration * dt * i;
    solver.step(p.state, p.loads, dt);
    ASSERT_NEAR(p.state.joint[0].rate, acceleration * dt * i, 1e-13);
    // I alpha + load + damping, exact for the discrete rates.
    ASSERT_NEAR(p.state.joint[0].driveForce, 0.7 * acceleration + 40 + 0.5 * acceleration * dt * i, 1e-10);
  }
  EXPECT_NEAR(p.state.joint[0].position, acceleration * dt * dt * 1000 * 1001 / 2, 1e-10);
  const double kinetic = 0.5 * 0.7 * 3 * 3;
  EXPECT_NEAR(p.state.ledger.driveWork + p.state.ledger.externalWork - p.state.ledger.dissipated, kinetic, 1e-10);
}

TEST(MultibodyDrive, ConstantSpeedAgainstGravityReadsTheWeightsTorque) {
  const double m = 4, l = 0.3, w = 1.5, dt = 1e-4;
  Mechanism p;
  p.model.addBody(makeBody("arm", m, kSprocketInertia, {{l, 0, 0}, {}}, cross(w * kY, Vec3d{l, 0, 0}), w * kY));
  p.model.addJointAt("axle", JointType::kRevolute, kWorld, 0, frameWithZ({}, kY));
  p.model.addDrive({"motor", 0, w, true});
  p.start();
  Solver solver(p.model);
  solver.step(p.state, p.loads, dt);
  double worst = 0;
  for (int i = 0; i < 50000; ++i) {
    const double angle = p.state.joint[0].position;
    solver.step(p.state, p.loads, dt);
    worst = std::max(worst, std::fabs(p.state.joint[0].driveForce + m * 9.81 * l * base::cos(angle)));
  }
  EXPECT_NEAR(p.state.joint[0].position, w * dt * 50001, 1e-9);
  EXPECT_LT(worst, 1e-5); // order (w dt)^2 of the centrifugal force's lever arm, and round-off
}

TEST(MultibodyDrive, SwitchedOffTheAxisIsFree) {
  Mechanism p;
  p.model.addBody(makeBody("wheel", 5, kSprocketInertia, {}, {}, {0, 2, 0}));
  p.model.addJointAt("axle", JointType::kRevolute, kWorld, 0, frameWithZ({}, kY));
  p.model.addDrive({"motor", 0, 7, false});
  p.start();
  Solver solver(p.model);
  for (int i = 0; i < 10; ++i) solver.step(p.state, p.loads, 1e-3);
  EXPECT_NEAR(p.state.joint[0].rate, 2, 1e-14);
  EXPECT_EQ(p.state.joint[0].driveForce, 0);
  p.loads.drives[0].on = true;
  solver.step(p.state, p.loads, 1e-3);
  EXPECT_NEAR(p.state.joint[0].rate, 7, 1e-14);
  EXPECT_NEAR(p.state.joint[0].driveForce, 0.7 * 5 / 1e-3, 1e-9);
}

/// B2: four-bar with N = 2 loops: three uprights, two couplers, rods of 1 m and 1 kg, all revolute.
Mechanism fourBar() {
  Mechanism m;
  const Mat3d rod = Mat3d::diagonal({1.0 / 12, 1.0 / 12, 1e-3}); // along z
  for (int i = 0; i < 3; ++i)
    m.model.addBody(makeBody("upright " + std::to_string(i), 1, rod, {{1.0 * i, 0, 0.5}, {}}, {0.5, 0, 0}, {0, 1, 0}));
  for (int i = 0; i < 2; ++i)
    m.model.addBody(
        makeBody("coupler " + std::to_string(i), 1, rod, {{0.5 + i, 0, 1}, aboutY(base::kPi / 2)}, {1, 0, 0}));
  for (int i = 0; i < 3; ++i)
    m.model.addJointAt("foot " + std::to_string(i), JointType::kRevolute, kWorld, i, frameWithZ({1.0 * i, 0, 0}, kY));
  m.model.addJointAt("B0", JointType::kRevolute, 0, 3, frameWithZ({0, 0, 1}, kY));
  m.model.addJointAt("B1 left", JointType::kRevolute, 1, 3, frameWithZ({1, 0, 1}, kY));
  m.model.addJointAt("B1 right", JointType::kRevolute, 1, 4, frameWithZ({1, 0, 1}, kY));
  m.model.addJointAt("B2", JointType::kRevolute, 2, 4, frameWithZ({2, 0, 1}, kY));
  m.start();
  return m;
}

double fourBarError(double dt, int& singular) {
  Mechanism m = fourBar();
  Solver solver(m.model);
  EXPECT_EQ(solver.redundantRowNames().size(), 6u) << solver.report(); // three per loop
  const int steps = static_cast<int>(std::lround(10 / dt));
  for (int i = 0; i < steps; ++i) {
    solver.step(m.state, m.loads, dt);
    singular += solver.lastStep().singularRows;
    EXPECT_LE(solver.lastStep().maxPositionError, 1e-9);
  }
  const Vec3d b0 = m.state.pose[0].toWorld({0, 0, 0.5});
  return length(b0 - Vec3d{.328458111541, 0, .944518538179});
}

TEST(MultibodyFourBar, PassesItsSingularPositionsAndFollowsTheExactSolution) {
  int singular = 0;
  const double coarse = fourBarError(2e-3, singular), fine = fourBarError(1e-3, singular),
               finer = fourBarError(5e-4, singular);
  std::printf("four-bar error at 10 s: %.3e %.3e %.3e m, orders %.2f %.2f, %d singular rows on the way\n", coarse, fine,
              finer, std::log2(coarse / fine), std::log2(fine / finer), singular);
  // The scheme's only first-order error is the half-step force of the start, which vanishes upright.
  EXPECT_LT(finer, 1e-5); // measured 4.2e-6
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
  EXPECT_NEAR(std::log2(fine / finer), 2, 0.1);
}

TEST(MultibodyFourBar, StartsInItsSingularPositionWithoutDroppingNeededRows) {
  // Uprights along x: all bodies in one line.
  Model flat;
  for (int i = 0; i < 3; ++i)
    flat.addBody(makeBody("upright " + std::to_string(i), 1, Mat3d::diagonal({1.0 / 12, 1.0 / 12, 1e-3}),
                          {{i + 0.5, 0, 0}, aboutY(base::kPi / 2)}, {0, 0, -0.5}, {0, 1, 0}));
  for (int i = 0; i < 2; ++i)
    flat.addBody(makeBody("coupler " + std::to_string(i), 1, Mat3d::diagonal({1.0 / 12, 1.0 / 12, 1e-3}),
                          {{1.5 + i, 0, 0}, aboutY(base::kPi / 2)}, {0, 0, -1}));
  for (int i = 0; i < 3; ++i)
    flat.addJointAt("foot " + std::to_string(i), JointType::kRevolute, kWorld, i, frameWithZ({1.0 * i, 0, 0}, kY));
  flat.addJointAt("B0", JointType::kRevolute, 0, 3, frameWithZ({1, 0, 0}, kY));
  flat.addJointAt("B1 left", JointType::kRevolute, 1, 3, frameWithZ({2, 0, 0}, kY));
  flat.addJointAt("B1 right", JointType::kRevolute, 1, 4, frameWithZ({2, 0, 0}, kY));
  flat.addJointAt("B2", JointType::kRevolute, 2, 4, frameWithZ({3, 0, 0}, kY));
  Solver solver(flat);
  EXPECT_EQ(solver.redundantRowNames().size(), 6u) << solver.report();
  EXPECT_NE(solver.report().find("singular position"), std::string::npos) << solver.report();
  State state = makeState(flat);
  const Loads loads = makeLoads(flat);
  for (int i = 0; i < 2000; ++i) solver.step(state, loads, 1e-3);
  // All uprights are still parallel.
  EXPECT_NEAR(state.pose[2].position.z - state.pose[0].position.z, 0, 1e-6);
}

} // namespace
} // namespace grouser::multibody::test
