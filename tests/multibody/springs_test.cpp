// SPDX-License-Identifier: BSD-3-Clause
#include "mechanisms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grouser::multibody::test {
namespace {

/// The scheme's own recurrence for one degree of freedom: inertia, stiffness, damping, force at x = 0.
struct Recurrence {
  double inertia, stiffness, damping, load;
  double x = 0, v = 0;
  void step(double dt) {
    v = (v + dt * (load - stiffness * x) / inertia) / (1 + (dt * damping + dt * dt * stiffness) / inertia);
    x += dt * v;
  }
};

TEST(MultibodySprings, TorsionSpringWithPreloadFollowsItsRecurrenceAndFrequency) {
  const double k = 50, c = 0.02, preload = 4, inertia = 0.2, dt = 1e-4;
  Mechanism p;
  p.model.addBody(makeBody("wheel", 2, kWheelInertia, {{1, 2, 3}, {}}));
  p.model.addJointAt("axle", JointType::kRevolute, kWorld, 0, frameWithZ({1, 2, 3}, kY));
  AxisSpring spring{"torsion", 0, k, c, 0.1, preload};
  p.model.addAxisSpring(spring);
  p.start();
  Solver solver(p.model);
  Recurrence exact{inertia, k, c, preload + k * 0.1};
  double lastUp = 0, period = 0, previous = -1;
  const double rest = 0.1 + preload / k;
  for (int i = 0; i < 20000; ++i) {
    solver.step(p.state, p.loads, dt);
    exact.step(dt);
    ASSERT_NEAR(p.state.joint[0].position, exact.x, 1e-11) << i; // round-off of 20000 rotations
    const double now = p.state.joint[0].position - rest;
    if (previous < 0 && now >= 0) {
      const double t = p.state.time - dt * now / (now - previous);
      if (lastUp > 0) period = t - lastUp;
      lastUp = t;
    }
    previous = now;
  }
  const double omega = std::sqrt(k / inertia);
  EXPECT_NEAR(period, 2 * base::kPi / omega, 1e-5); // frequency error of order (omega dt)^2 and of the damping's square
}

TEST(MultibodySprings, SliderOnSpringSettlesAtPreloadAndWeight) {
  const double m = 28, k = 3e5, c = 4000, preload = 9200, dt = 5e-5;
  Mechanism p;
  p.model.addBody(makeBody("carrier", m, kWheelInertia, {}));
  p.model.addJointAt("slide", JointType::kPrismatic, kWorld, 0, frameWithZ({}, {0, 0, 1}));
  AxisSpring spring;
  spring.name = "tensioner", spring.joint = 0, spring.stiffness = k, spring.damping = c, spring.preload = preload;
  p.model.addAxisSpring(spring);
  p.start();
  Solver solver(p.model);
  Recurrence exact{m, k, c, preload - m * 9.81};
  for (int i = 0; i < 40000; ++i) {
    solver.step(p.state, p.loads, dt);
    exact.step(dt);
    ASSERT_NEAR(p.state.joint[0].position, exact.x, 1e-12) << i;
  }
  EXPECT_NEAR(p.state.joint[0].position, (preload - m * 9.81) / k, 1e-9);
  EXPECT_NEAR(p.state.joint[0].springForce, m * 9.81, 1e-5);
  // Energy: the spring's work is lifted or dissipated.
  const Totals t = totals(p.model, p.state, p.loads);
  EXPECT_NEAR(p.state.ledger.springWork + p.state.ledger.gravityWork, p.state.ledger.dissipated, 1e-8);
  EXPECT_NEAR(-t.elastic, p.state.ledger.springWork, 0.02 * std::fabs(t.elastic)); // implicit spring: loss of order dt
}

TEST(MultibodySprings, RampedPreloadFollowsTheLoadFactor) {
  Mechanism p;
  p.model.addBody(makeBody("carrier", 10, kWheelInertia, {}));
  p.model.addJointAt("slide", JointType::kPrismatic, kWorld, 0, frameWithZ({}, {1, 0, 0}));
  AxisSpring spring;
  spring.name = "tensioner", spring.joint = 0, spring.stiffness = 1e4, spring.damping = 2000, spring.preload = 500;
  p.model.addAxisSpring(spring);
  p.start();
  p.loads.axisSprings[0].loadFactor = 0;
  Solver solver(p.model);
  for (int i = 0; i < 100; ++i) solver.step(p.state, p.loads, 1e-3);
  EXPECT_NEAR(p.state.joint[0].position, 0, 1e-15);
  for (int i = 0; i < 20000; ++i) {
    p.loads.axisSprings[0].loadFactor = std::min(1.0, i / 10000.0);
    solver.step(p.state, p.loads, 1e-3);
  }
  EXPECT_NEAR(p.state.joint[0].position, 0.05, 1e-9);
}

TEST(MultibodySprings, EndStopsHoldALoadWithTheirOwnStiffness) {
  const double load = 2000, stop = 5e6, dt = 5e-5;
  Mechanism p;
  p.model.addBody(makeBody("carrier", 28, kWheelInertia, {}));
  p.model.addJointAt("slide", JointType::kPrismatic, kWorld, 0, frameWithZ({}, {1, 0, 0}));
  AxisSpring spring;
  spring.name = "tensioner", spring.joint = 0;
  spring.lowerLimit = -0.015, spring.upperLimit = 0.025, spring.stopStiffness = stop, spring.stopDamping = 5000;
  p.model.addAxisSpring(spring);
  p.start();
  p.loads.gravity = {};
  Solver solver(p.model);
  for (const double side : {1.0, -1.0}) {
    p.loads.external[0].force = {side * load, 0, 0};
    double furthest = 0;
    for (int i = 0; i < 40000; ++i) {
      solver.step(p.state, p.loads, dt);
      furthest = std::max(furthest, side * p.state.joint[0].position);
    }
    const double limit = side > 0 ? 0.025 : 0.015;
    EXPECT_NEAR(side * p.state.joint[0].position, limit + load / stop, 1e-7);
    EXPECT_LT(furthest, limit + 0.01); // impact from 40 mm with 2 kN: sqrt(2 * 80 J / 5e6) = 5.7 mm
  }
}

TEST(MultibodySprings, PointSpringOscillatesAtItsFrequency) {
  // Two free masses, a spring between them: omega^2 = k (1/m1 + 1/m2); momentum stays zero.
  const double k = 2000, m1 = 2, m2 = 3, l0 = 0.5, dt = 1e-5;
  Mechanism p;
  p.model.addBody(makeBody("one", m1, kWheelInertia, {{0, 0, 0}, {}}));
  p.model.addBody(makeBody("two", m2, kWheelInertia, {{0.6, 0, 0}, {}}));
  PointSpring spring;
  spring.name = "spring", spring.bodyA = 0, spring.bodyB = 1, spring.stiffness = k, spring.restLength = l0;
  p.model.addPointSpring(spring);
  p.start();
  p.loads.gravity = {};
  Solver solver(p.model);
  const double omega = std::sqrt(k * (1 / m1 + 1 / m2));
  const int half = static_cast<int>(std::lround(base::kPi / omega / dt));
  for (int i = 0; i < half; ++i) solver.step(p.state, p.loads, dt);
  // After half a period 0.1 m of elongation becomes 0.1 m of compression, minus the implicit spring's damping of
  // omega dt / 2 per radian: 0.1 pi omega dt / 2 = 6.4e-5 m.
  EXPECT_NEAR(p.state.spring[0].length, l0 - 0.1, 1e-4);
  EXPECT_NEAR(length(totals(p.model, p.state, p.loads).linearMomentum), 0, 1e-12);
  EXPECT_NEAR(p.state.spring[0].force, k * 0.1, 0.5);
}

TEST(MultibodySprings, HeavyJointDampingIsStableAtAnyStep) {
  // 0.02 kg m2 and 100 N m s/rad: explicit damping would require steps below 0.4 ms.
  for (const double c : {5.0, 100.0})
    for (const double dt : {5e-5, 1e-3, 0.1}) {
      Mechanism p;
      p.model.addBody(makeBody("link", 1, Mat3d::diagonal({0.03, 0.02, 0.03}), {}, {}, {0, 3, 0}));
      p.model.addJointAt("pin", JointType::kRevolute, kWorld, 0, frameWithZ({}, kY), c);
      p.start();
      Solver solver(p.model);
      double w = 3;
      for (int i = 0; i < 20; ++i) {
        solver.step(p.state, p.loads, dt);
        w /= 1 + dt * c / 0.02;
        ASSERT_NEAR(p.state.joint[0].rate, w, 1e-12);
      }
    }
}

TEST(MultibodySprings, ClosingTheJointsDoesNotMoveSoftRows) {
  // A rod on a damped pin, off its centre of mass, so that every step opens and closes the joint. The angle
  // must follow the damping only: w = w0 exp(-c t / I), angle = w0 I / c (1 - exp(-c t / I)).
  const double c = 0.8, l = 0.5, m = 2, inertia = 0.2 + m * l * l, w0 = 12, dt = 1e-5;
  Mechanism p;
  p.model.addBody(makeBody("rod", m, kWheelInertia, {{l, 0, 0}, {}}, cross(w0 * kY, Vec3d{l, 0, 0}), w0 * kY));
  p.model.addJointAt("pin", JointType::kRevolute, kWorld, 0, frameWithZ({}, kY), c);
  p.start();
  p.loads.gravity = {};
  Solver solver(p.model);
  for (int i = 0; i < 100000; ++i) solver.step(p.state, p.loads, dt);
  const double decay = base::exp(-c / inertia);
  EXPECT_NEAR(p.state.joint[0].rate, w0 * decay, 1e-4);
  EXPECT_NEAR(p.state.joint[0].position, w0 * inertia / c * (1 - decay), 2e-4); // order w0 dt
  EXPECT_NEAR(p.state.ledger.dissipated, 0.5 * inertia * w0 * w0 * (1 - decay * decay), 2e-3);
}

} // namespace
} // namespace grouser::multibody::test
