// SPDX-License-Identifier: BSD-3-Clause
#include "mechanisms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grouser::multibody::test {
namespace {

const Mat3d kBallInertia = Mat3d::diagonal({0.3, 0.2, 0.25});

TEST(MultibodyJoints, PrismaticSlidesDownAnInclineAsTheDiscreteFall) {
  // Slope 30 degrees: s = g sin(30) dt^2 n (n + 1) / 2 of the symplectic recurrence; reaction m g cos(30) across.
  const double angle = base::kPi / 6, m = 3, dt = 1e-3;
  const Vec3d down{base::cos(angle), 0, -base::sin(angle)};
  Mechanism p;
  p.model.addBody(makeBody("slider", m, kBallInertia, {{0, 0, 1}, {}}));
  p.model.addJointAt("rail", JointType::kPrismatic, kWorld, 0, frameWithZ({0, 0, 1}, down));
  p.start();
  Solver solver(p.model);
  const int n = 1000;
  for (int i = 0; i < n; ++i) solver.step(p.state, p.loads, dt);
  const double s = 9.81 * base::sin(angle) * dt * dt * n * (n + 1) / 2;
  EXPECT_NEAR(p.state.joint[0].position, s, 1e-10); // positionTolerance
  EXPECT_NEAR(p.state.joint[0].rate, 9.81 * base::sin(angle) * dt * n, 1e-10);
  EXPECT_NEAR(length(p.state.joint[0].force), m * 9.81 * base::cos(angle), 1e-7);
  EXPECT_NEAR(dot(p.state.joint[0].force, down), 0, 1e-7);
}

TEST(MultibodyJoints, PrismaticRailTakesTheTorqueOfALoadBesideIt) {
  Mechanism p;
  p.model.addBody(makeBody("slider", 2, kBallInertia, {{0.4, 0, 0}, {}}));
  p.model.addJointAt("rail", JointType::kPrismatic, kWorld, 0, frameWithZ({0, 0, 0}, kY));
  p.start();
  Solver solver(p.model);
  solver.step(p.state, p.loads, 1e-3);
  EXPECT_NEAR(p.state.joint[0].force.z, 2 * 9.81, 1e-9);
  // The weight at 0.4 m causes a moment about +y; the rail resists it.
  EXPECT_NEAR(p.state.joint[0].torque.y, -2 * 9.81 * 0.4, 1e-9);
}

TEST(MultibodyJoints, FixedJointsCarryACantileverOfTwoBodies) {
  const double m = 5, g = 9.81;
  Mechanism p;
  p.model.addBody(makeBody("inner", m, kBallInertia, {{0.5, 0, 0}, {}}));
  p.model.addBody(makeBody("outer", m, kBallInertia, {{1.5, 0, 0}, aboutY(0.3)}));
  p.model.addJointAt("wall", JointType::kFixed, kWorld, 0, {{0, 0, 0}, {}});
  p.model.addJointAt("splice", JointType::kFixed, 0, 1, {{1, 0, 0}, aboutY(1)});
  p.start();
  Solver solver(p.model);
  for (int i = 0; i < 100; ++i) solver.step(p.state, p.loads, 1e-3);
  EXPECT_NEAR(p.state.joint[0].force.z, 2 * m * g, 1e-8);
  EXPECT_NEAR(p.state.joint[0].torque.y, -(m * g * 0.5 + m * g * 1.5), 1e-8);
  EXPECT_NEAR(p.state.joint[1].force.z, m * g, 1e-8);
  EXPECT_NEAR(p.state.joint[1].torque.y, -m * g * 0.5, 1e-8);
  EXPECT_NEAR(length(p.state.pose[1].position - Vec3d{1.5, 0, 0}), 0, 1e-10);
}

TEST(MultibodyJoints, SphericalHoldsAConicalPendulum) {
  // Point mass on 1 m at 30 degrees: w^2 = g / (l cos), tension m g / cos, constant height.
  const double m = 1.5, tilt = base::kPi / 6, w = std::sqrt(9.81 / base::cos(tilt)), dt = 1e-4;
  const Vec3d x{base::sin(tilt), 0, -base::cos(tilt)}, spin{0, 0, w};
  Mechanism p;
  p.model.addBody(makeBody("bob", m, pointInertia(), {x, {}}, cross(spin, x), spin));
  p.model.addJointAt("ball", JointType::kSpherical, kWorld, 0, {});
  p.start();
  Solver solver(p.model);
  const int n = 20000;
  double rise = 0;
  for (int i = 0; i < n; ++i) {
    solver.step(p.state, p.loads, dt);
    rise = std::max(rise, std::fabs(p.state.pose[0].position.z - x.z));
  }
  EXPECT_LT(rise, 3e-4); // half a step of gravity at the start: g dt / 2 over the frequency, 1.5e-4 m
  EXPECT_NEAR(length(p.state.joint[0].force), m * 9.81 / base::cos(tilt), 5e-3);
  EXPECT_NEAR(base::atan2(p.state.pose[0].position.y, p.state.pose[0].position.x),
              base::atan2(base::sin(w * n * dt), base::cos(w * n * dt)), 2e-3);
}

TEST(MultibodyJoints, UniversalTurnsTheOutputShaftByHookesLaw) {
  // Shafts under 35 degrees, each in its own bearing: tan(out) = tan(in) / cos(bend), where the input's pin starts
  // in the plane of the shafts; the rate follows by differentiation.
  const double bend = 35 * base::kPi / 180, dt = 1e-4;
  const Vec3d outAxis{base::sin(bend), 0, base::cos(bend)};
  Mechanism p;
  p.model.addBody(makeBody("in", 1, kBallInertia, {{0, 0, -0.5}, {}}));
  p.model.addBody(makeBody("out", 1, kBallInertia, {0.5 * outAxis, aboutY(bend)}));
  p.model.addJointAt("bearing in", JointType::kRevolute, kWorld, 0, frameWithZX({0, 0, -0.5}, {0, 0, 1}, {1, 0, 0}));
  p.model.addJointAt("bearing out", JointType::kRevolute, kWorld, 1, frameWithZX(0.5 * outAxis, outAxis, kY));
  // Pin of the input along x (z of the joint frame), pin of the output along y (x of the joint frame).
  p.model.addJointAt("cross", JointType::kUniversal, 0, 1, frameWithZX({0, 0, 0}, {1, 0, 0}, kY));
  p.model.addDrive({"motor", 0, 2.0, true});
  p.start();
  p.loads.gravity = {};
  Solver solver(p.model);
  EXPECT_EQ(solver.redundantRowNames().size(), 3u)
      << solver.report(); // the two bearings already hold the centre of the cross
  double worst = 0;
  for (int i = 0; i < 40000; ++i) {
    solver.step(p.state, p.loads, dt);
    const double in = p.state.joint[0].position, out = p.state.joint[1].position;
    // tan(in) = cos(bend) tan(out), without its poles.
    worst =
        std::max(worst, std::fabs(base::sin(in) * base::cos(out) - base::cos(bend) * base::cos(in) * base::sin(out)));
  }
  EXPECT_NEAR(p.state.joint[0].position, 8.0, 1e-9);
  EXPECT_NEAR(p.state.joint[1].rate, 2 * base::cos(bend) / (1 - std::pow(base::sin(bend) * base::cos(8.0), 2)), 2e-3);
  EXPECT_LT(worst, 1e-9); // position constraints hold to their tolerance
}

TEST(MultibodyJoints, HangingChainCarriesExactStaticTensions) {
  // N links and a tip mass: ((N - i) m + M) g, for mass ratios up to a million.
  for (const double tip : {0.0, 1e3, 1e6}) {
    const int n = 100;
    const double m = 1, l = 0.15, g = 9.81;
    Mechanism p;
    for (int i = 0; i < n; ++i)
      p.model.addBody(makeBody("link " + std::to_string(i), m, Mat3d::diagonal({0.002, 0.002, 0.001}),
                               {{0, 0, -l * (i + 0.5)}, {}}));
    if (tip > 0) p.model.addBody(makeBody("tip", tip, Mat3d::diagonal({tip, tip, tip}), {{0, 0, -l * n}, {}}));
    for (int i = 0; i < n; ++i)
      p.model.addJointAt("pin " + std::to_string(i), JointType::kRevolute, i - 1, i, frameWithZ({0, 0, -l * i}, kY));
    if (tip > 0) p.model.addJointAt("hook", JointType::kFixed, n - 1, n, {{0, 0, -l * n}, {}});
    p.start();
    Solver solver(p.model);
    EXPECT_EQ(solver.redundantRowNames().size(), 0u) << solver.report();
    for (int i = 0; i < 1000; ++i) solver.step(p.state, p.loads, 1e-4);
    double worst = 0;
    for (int i = 0; i < n; ++i) {
      const double exact = ((n - i) * m + tip) * g;
      worst = std::max(worst, std::fabs(p.state.joint[static_cast<std::size_t>(i)].force.z - exact) / exact);
    }
    EXPECT_LT(worst, 1e-7) << tip; // round-off of positions over dt^2, relative to the weights
    EXPECT_NEAR(p.state.pose[static_cast<std::size_t>(n - 1)].position.z, -l * (n - 0.5), 1e-9);
  }
}

} // namespace
} // namespace grouser::multibody::test
