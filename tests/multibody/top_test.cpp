// SPDX-License-Identifier: BSD-3-Clause
#include "mechanisms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace grouser::multibody::test {
namespace {

/// D1: free asymmetric top, I = (1, 2, 3) kg m2.
Mechanism top(const Vec3d& w) {
  Mechanism m;
  m.model.addBody(makeBody("top", 1, Mat3d::diagonal({1, 2, 3}), {}, {}, w));
  m.start();
  m.loads.gravity = {};
  return m;
}

/// Geodesic distance of two orientations [rad].
double attitudeError(const Quat& a, const Quat& b) {
  const Quat d = a * b.conjugate();
  return 2 * std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

double attitudeErrorAt10(double dt, const SolverOptions& options = {}) {
  Mechanism m = top({1, 1, 1});
  Solver solver(m.model, options);
  const Vec3d before = totals(m.model, m.state, m.loads).angularMomentum;
  const int steps = static_cast<int>(std::lround(10 / dt));
  for (int i = 0; i < steps; ++i) solver.step(m.state, m.loads, dt);
  const Vec3d after = totals(m.model, m.state, m.loads).angularMomentum;
  EXPECT_EQ(after.x, before.x); // no torque, no change: to the last bit
  EXPECT_EQ(after.y, before.y);
  EXPECT_EQ(after.z, before.z);
  const Quat reference{.462545440555, -.314335145145, .049429631279, .827527548484};
  return attitudeError(m.state.pose[0].orientation, reference);
}

TEST(MultibodyTop, AttitudeFollowsTheClosedFormWithOrderTwo) {
  const double coarse = attitudeErrorAt10(4e-3), middle = attitudeErrorAt10(2e-3), fine = attitudeErrorAt10(1e-3);
  std::printf("free top, attitude error at 10 s: %.3e %.3e %.3e rad, orders %.3f %.3f\n", coarse, middle, fine,
              std::log2(coarse / middle), std::log2(middle / fine));
  EXPECT_LT(fine, 1e-5);
  EXPECT_NEAR(std::log2(coarse / middle), 2, 0.05);
  EXPECT_NEAR(std::log2(middle / fine), 2, 0.05);
}

TEST(MultibodyTop, ExactGyroscopicsKeepTheOrderOverAllSteps) {
  // With a tolerance of 1e-10 rad the equation needs one iteration less below 4e-4 s, and the error is 10 times larger.
  SolverOptions options;
  options.exactGyroscopics = true;
  double before = 0;
  for (const double dt : {1.6e-2, 4e-3, 1e-3, 2.5e-4, 6.25e-5}) {
    const double error = attitudeErrorAt10(dt, options);
    if (before > 0) {
      EXPECT_NEAR(std::log2(before / error), 4, 0.1) << dt; // order 2 over a quarter of the step
    }
    before = error;
  }
}

TEST(MultibodyTop, FlipsAtTheClosedFormIntervals) {
  // Dzhanibekov: w0 = (0.01, 5, 0.01) about the middle axis flips every 5.02592913816 s.
  Mechanism m = top({0.01, 5, 0.01});
  Solver solver(m.model);
  const double dt = 5e-4;
  double last = 5, first = 0, second = 0;
  for (int i = 0; i < 20000; ++i) {
    solver.step(m.state, m.loads, dt);
    const Vec3d w_B = transposedTimes(m.state.pose[0].orientation.matrix(), m.state.twist[0].w);
    if (last * w_B.y < 0) (first == 0 ? first : second) = m.state.time - dt / 2;
    last = w_B.y;
  }
  EXPECT_NEAR(second - first, 5.02592913816, 2e-3);
}

TEST(MultibodyTop, EnergyOfAFastTopStaysBounded) {
  // Half a radian per step about the unstable axis: an explicit gyroscopic term would be unstable here.
  Mechanism m = top({0.5, 50, 0.5});
  Solver solver(m.model);
  solver.step(m.state, m.loads, 0.01);
  const double start = totals(m.model, m.state, m.loads).kinetic;
  double lowest = start, highest = start;
  for (int i = 0; i < 100000; ++i) {
    solver.step(m.state, m.loads, 0.01);
    const double e = totals(m.model, m.state, m.loads).kinetic;
    lowest = std::min(lowest, e), highest = std::max(highest, e);
  }
  std::printf("fast top: energy within %.4f .. %.4f of its start\n", lowest / start, highest / start);
  EXPECT_GT(lowest / start, 0.9);
  EXPECT_LT(highest / start, 1.1);
}

TEST(MultibodyTop, SteadyPrecessionOfAHeavyTop) {
  // Disc on a rod in a spherical joint, spinning fast: slow steady precession satisfies
  //   (I3 - I1) cos(theta) W^2 + I3 s W - m g l = 0 at theta = 90 degrees, i.e. W = m g l / (I3 s) exactly.
  const double m = 2, l = 0.3, i3 = 0.04, i1 = 0.03, spin = 80, W = m * 9.81 * l / (i3 * spin);
  Mechanism p;
  const Pose X{{l, 0, 0}, {}};
  p.model.addBody(
      makeBody("disc", m, Mat3d::diagonal({i3, i1, i1}), X, cross(Vec3d{0, 0, W}, X.position), {spin, 0, W}));
  p.model.addJointAt("tip", JointType::kSpherical, kWorld, 0, {});
  p.start();
  Solver solver(p.model);
  const double dt = 1e-4;
  const int steps = static_cast<int>(base::kPi / (2 * W) / dt); // a quarter turn
  double nod = 0;
  for (int i = 0; i < steps; ++i) {
    solver.step(p.state, p.loads, dt);
    nod = std::max(nod, std::fabs(p.state.pose[0].position.z));
  }
  const Vec3d& x = p.state.pose[0].position;
  EXPECT_LT(nod, 1e-4); // nutation caused by the half step, of order dt
  EXPECT_NEAR(base::atan2(x.y, x.x), W * steps * dt, 1e-3);
}

} // namespace
} // namespace grouser::multibody::test
