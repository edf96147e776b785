// SPDX-License-Identifier: BSD-3-Clause
#include "mechanisms.hpp"
#include "multibody/detail/constraint_system.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace grouser::multibody::test {
namespace {

Mechanism ring(const RingSpec& spec) {
  Mechanism m;
  addRing(m.model, spec);
  m.start();
  m.loads.gravity = {};
  return m;
}

/// Joint force of a free spinning ring of links: m w^2 R cos(pi/N) / (2 sin(pi/N)).
double spinningForce(const RingSpec& s) {
  const double a = base::kPi / s.links;
  return s.mass * s.spin * s.spin * pinRadius(s) * base::cos(a) / (2 * base::sin(a));
}

class MultibodyRing : public ::testing::TestWithParam<RingJoints> {};

TEST_P(MultibodyRing, SpinningFreelyHasTheClosedFormTensionInEveryJoint) {
  RingSpec spec;
  spec.spin = 10;
  spec.joints = GetParam();
  EXPECT_NEAR(spinningForce(spec), 535.571714, 1e-6);
  Mechanism m = ring(spec);
  Solver solver(m.model);
  const double dt = 1e-4;
  solver.step(m.state, m.loads, dt); // from the tangential start velocity: half the impulse
  double worst = 0, gap = 0;
  for (int i = 0; i < 20000; ++i) { // 2 s, 3.2 turns
    solver.step(m.state, m.loads, dt);
    for (const JointReading& joint : m.state.joint)
      worst = std::max(worst, std::fabs(length(joint.force) - spinningForce(spec)));
    gap = std::max(gap, solver.lastStep().maxPositionError);
  }
  std::printf("spinning ring: joint force off by at most %.3e N, gap %.3e m\n", worst, gap);
  // Central differences of a rotation: relative (w dt)^2 / 12 = 8e-8; the rest is the start's (w dt)^2 / 8 in speed,
  // and gaps of round-off size over dt^2.
  EXPECT_LT(worst, 2e-3);
  EXPECT_LE(gap, 1e-10);
  // The mean twist of a step violates the constraints at its end by half a step of centripetal acceleration, w^2 p dt
  // / 2.
  EXPECT_LT(solver.velocityError(m.state), 1.1 * spec.spin * spec.spin * spec.pitch * dt / 2);
}

TEST_P(MultibodyRing, PerturbedLinkKeepsMomentumAndEnergy) {
  RingSpec spec;
  spec.spin = 10;
  spec.joints = GetParam();
  Mechanism m = ring(spec);
  Solver solver(m.model);
  const double dt = 1e-4;
  // An impulse of 3 N s on one link, in the plane and off its centre.
  m.loads.external[5] = {{2e4, 0, 2.2e4}, {0, 30, 0}};
  solver.step(m.state, m.loads, dt);
  m.loads.external[5] = {};
  for (int i = 0; i < 10; ++i) solver.step(m.state, m.loads, dt);
  const Totals start = totals(m.model, m.state, m.loads);
  double energyDrift = 0, gap = 0;
  for (int i = 0; i < 10000; ++i) {
    solver.step(m.state, m.loads, dt);
    energyDrift = std::max(energyDrift, std::fabs(totals(m.model, m.state, m.loads).kinetic - start.kinetic));
    gap = std::max(gap, solver.lastStep().maxPositionError);
  }
  const Totals end = totals(m.model, m.state, m.loads);
  const double p = length(end.linearMomentum - start.linearMomentum) / length(start.linearMomentum);
  const double l = length(end.angularMomentum - start.angularMomentum) / length(start.angularMomentum);
  std::printf("perturbed ring, 1 s: momentum %.2e, angular %.2e, energy %.2e (relative), gap %.2e m\n", p, l,
              energyDrift / start.kinetic, gap);
  EXPECT_LT(p, 1e-10); // round-off of 46 joints' impulses over 1e4 steps
  EXPECT_LT(l, 1e-10);
  EXPECT_LT(energyDrift / start.kinetic, 5e-4); // bounded, of order dt
  EXPECT_LE(gap, 1e-10);
  for (const Pose& X : m.state.pose) EXPECT_NEAR(X.position.y, 0, 1e-9); // stays in its plane
}

INSTANTIATE_TEST_SUITE_P(Joints, MultibodyRing,
                         ::testing::Values(RingJoints::kAllRevolute, RingJoints::kOneSphericalOneUniversal));

TEST(MultibodyRingRedundancy, DroppedRowsStayClosedWhenTheRingTumblesInSpace) {
  // The ring rotated about an oblique axis, with a lateral impulse on one link: the rows dropped at the start,
  // in the plane, must be redundant in every position.
  RingSpec spec;
  spec.spin = 6;
  Mechanism m = ring(spec);
  for (std::size_t b = 0; b < m.state.twist.size(); ++b) {
    const Vec3d w{2, 1, 3};
    const Twist& V = m.state.twist[b];
    setTwist(m.model, m.state, static_cast<int>(b), {V.v + cross(w, m.state.pose[b].position), V.w + w});
  }
  Solver solver(m.model);
  ASSERT_EQ(solver.redundantRowNames().size(), 3u);
  const detail::ConstraintSystem all(m.model); // with all rows
  std::vector<detail::Frame> frames;
  m.loads.external[5] = {{2e3, 1e3, 2e3}, {5, 3, 5}};
  double worst = 0;
  for (int i = 0; i < 10000; ++i) {
    solver.step(m.state, m.loads, 1e-4);
    m.loads.external[5] = {};
    if (i % 100 != 0) continue;
    all.place(m.state.pose, frames);
    for (const detail::Constraint& c : all.constraints()) {
      double error[6];
      detail::positionError(
          c, detail::framesOf(c, frames[static_cast<std::size_t>(c.bodyA)], frames[static_cast<std::size_t>(c.bodyB)]),
          error);
      for (const double e : error) worst = std::max(worst, std::fabs(e));
    }
  }
  std::printf("tumbling ring: largest error of any row, dropped ones included, %.2e\n", worst);
  EXPECT_LT(worst, 46 * 1e-10); // the tolerances of the ring's other joints add up
}

TEST(MultibodyRingRedundancy, AllRevoluteRingHasThreeRedundantRowsNamedInTheReport) {
  RingSpec spec;
  Mechanism m = ring(spec);
  const Solver solver(m.model);
  EXPECT_EQ(solver.redundantRowNames().size(), 3u) << solver.report();
  EXPECT_NE(solver.report().find("joint 'link pin "), std::string::npos) << solver.report();
}

TEST(MultibodyRingRedundancy, OneSphericalAndOneUniversalLeaveNone) {
  RingSpec spec;
  spec.joints = RingJoints::kOneSphericalOneUniversal;
  Mechanism m = ring(spec);
  const Solver solver(m.model);
  EXPECT_EQ(solver.redundantRowNames().size(), 0u) << solver.report();
}

TEST(MultibodyRingRedundancy, BothWaysGiveTheSameMotion) {
  RingSpec spec;
  spec.spin = 3;
  Mechanism a = ring(spec);
  spec.joints = RingJoints::kOneSphericalOneUniversal;
  Mechanism b = ring(spec);
  Solver solverA(a.model), solverB(b.model);
  for (Mechanism* m : {&a, &b}) m->loads.external[7].force = {20, 0, 50};
  for (int i = 0; i < 2000; ++i) solverA.step(a.state, a.loads, 1e-4), solverB.step(b.state, b.loads, 1e-4);
  double worst = 0;
  for (std::size_t i = 0; i < a.state.pose.size(); ++i)
    worst = std::max(worst, length(a.state.pose[i].position - b.state.pose[i].position));
  EXPECT_LT(worst, 1e-8); // positionTolerance over time
}

} // namespace
} // namespace grouser::multibody::test
