// SPDX-License-Identifier: BSD-3-Clause
#include "benchmarks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace grouser::multibody::test {
namespace {

/// A closed chain of revolutes from points and axes: link i joins pin i to pin i + 1; link 0 is the world.
Mechanism closedChain(const std::vector<Vec3d>& point, const std::vector<Vec3d>& axis) {
  Mechanism m;
  const int n = static_cast<int>(point.size());
  for (int i = 1; i < n; ++i) {
    const Vec3d &a = point[static_cast<std::size_t>(i)], &b = point[static_cast<std::size_t>((i + 1) % n)];
    m.model.addBody(makeBody("link " + std::to_string(i), 1, Mat3d::diagonal({0.02, 0.03, 0.04}), {0.5 * (a + b), {}}));
  }
  for (int i = 0; i < n; ++i) {
    const int before = i == 0 ? n - 2 : i - 2, after = i == 0 ? kWorld : i - 1;
    m.model.addJointAt("pin " + std::to_string(i), JointType::kRevolute, before < 0 ? kWorld : before, after,
                       frameWithZ(point[static_cast<std::size_t>(i)], axis[static_cast<std::size_t>(i)]));
  }
  m.start();
  return m;
}

/// Starts the mechanism along its degree of freedom with a kinetic energy of about 1 J, runs it, and checks that no
/// joint opens.
void expectMoves(Mechanism& m, const char* what, int freedom, int redundant, double duration = 5) {
  SolverOptions o = rattle();
  o.startVelocities = StartVelocities::kAccept;
  Solver solver(m.model, o);
  EXPECT_EQ(solver.degreesOfFreedom(), freedom) << what;
  EXPECT_EQ(solver.redundantRowNames().size(), static_cast<std::size_t>(redundant)) << what;
  m.loads.gravity = {};
  for (int b = 0; b < static_cast<int>(m.model.bodies().size()); ++b)
    setTwist(m.model, m.state, b, {{0.3, -0.5, 0.7}, {1.1 - b, 0.4 + b, -0.8}});
  solver.projectVelocities(m.state, m.loads);
  double start = energy(m);
  ASSERT_GT(start, 0);
  const double s = std::sqrt(1 / start);
  for (int b = 0; b < static_cast<int>(m.model.bodies().size()); ++b) {
    const Twist V = m.state.twist[static_cast<std::size_t>(b)];
    setTwist(m.model, m.state, b, {s * V.v, s * V.w});
  }
  start = energy(m);
  double gap = 0, all = 0, worst = 0, turned = 0;
  for (int i = 0; i < static_cast<int>(duration * 1000); ++i) {
    solver.step(m.state, m.loads, 1e-3);
    gap = std::max(gap, solver.lastStep().maxPositionError);
    worst = std::max(worst, std::fabs(energy(m) - start) / start);
    for (const Joint& j : m.model.joints()) {
      const auto at = [&](int b, const Vec3d& p) {
        return b == kWorld ? p : m.state.pose[static_cast<std::size_t>(b)].toWorld(p);
      };
      const double open = length(at(j.bodyA, j.frame_A.position) - at(j.bodyB, j.frame_B.position));
      if (j.type == JointType::kRevolute) all = std::max(all, open);
    }
    turned = std::max(turned, std::fabs(m.state.joint[0].position));
  }
  std::printf("%s: largest gap %.1e, pins with dropped rows %.1e m, energy within %.1e, first axis moved %.2f\n", what,
              gap, all, worst, turned);
  EXPECT_LT(gap, 1e-12) << what;
  EXPECT_LT(all, 1e-9) << what;
  EXPECT_LT(worst, 1e-2) << what;
  EXPECT_GT(turned, 0.3) << what;
}

TEST(Overconstrained, BennettLinkageMoves) {
  // Four revolutes in space: lengths a, b, twists alpha, beta with a / sin(alpha) = b / sin(beta) (Bennett 1903).
  const double a = 1, alpha = 0.6, beta = 1.1, b = a * std::sin(beta) / std::sin(alpha);
  // Denavit-Hartenberg: angles theta_1, theta_2 with tan(theta_1/2) tan(theta_2/2) =
  // sin((beta+alpha)/2)/sin((beta-alpha)/2).
  const double t1 = 1.3,
               t2 = 2 * std::atan(std::sin((beta + alpha) / 2) / std::sin((beta - alpha) / 2) / std::tan(t1 / 2));
  const double theta[4] = {t1, t2, 2 * base::kPi - t1, 2 * base::kPi - t2}, l[4] = {a, b, a, b},
               twist[4] = {alpha, beta, alpha, beta};
  std::vector<Vec3d> point, axis;
  Vec3d p{}, x{1, 0, 0}, z{0, 0, 1};
  for (int i = 0; i < 4; ++i) {
    point.push_back(p), axis.push_back(z);
    const Vec3d y = cross(z, x);
    x = std::cos(theta[i]) * x + std::sin(theta[i]) * y;
    p += l[i] * x;
    z = std::cos(twist[i]) * z + std::sin(twist[i]) * cross(x, z);
  }
  ASSERT_LT(length(p), 1e-12);
  Mechanism m = closedChain(point, axis);
  expectMoves(m, "Bennett", 1, 3);
}

TEST(Overconstrained, BricardsTrihedralLinkageMoves) {
  // Six revolutes along the edges of a cube, in order: neighbours perpendicular (special trihedral linkage of Bricard).
  const std::vector<Vec3d> point{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}, {0, 0, 1}};
  const std::vector<Vec3d> axis{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  Mechanism m = closedChain(point, axis);
  expectMoves(m, "Bricard", 1, 1);
}

TEST(Overconstrained, ExtraParallelRodsAreDropped) {
  // A parallelogram with five uprights where two suffice; planar, so each loop has three redundant rows, and each
  // extra upright one more.
  Mechanism m;
  m.model.addBody(makeBody("beam", 3, Mat3d::diagonal({0.1, 1, 1}), {{2, 0, 1}, {}}));
  for (int i = 0; i < 5; ++i) addRod(m.model, "upright " + std::to_string(i), {1.0 * i, 0, 0}, {1.0 * i, 0, 1});
  for (int i = 0; i < 5; ++i) {
    m.model.addJointAt("foot " + std::to_string(i), JointType::kRevolute, kWorld, 1 + i,
                       frameWithZ({1.0 * i, 0, 0}, kY));
    m.model.addJointAt("head " + std::to_string(i), JointType::kRevolute, 1 + i, 0, frameWithZ({1.0 * i, 0, 1}, kY));
  }
  m.start();
  expectMoves(m, "parallel rods", 1, 4 * 3 + 3);
}

TEST(Overconstrained, DoorOnThreeHinges) {
  Mechanism m;
  m.model.addBody(makeBody("door", 20, Mat3d::diagonal({7, 8, 1.1}), {{0.4, 0, 1}, {}}));
  for (const double z : {0.2, 1.0, 1.8})
    m.model.addJointAt("hinge " + std::to_string(z), JointType::kRevolute, kWorld, 0, {{0, 0, z}, {}});
  m.start();
  expectMoves(m, "door", 1, 10);
}

TEST(Overconstrained, SarrusLinkageMovesStraight) {
  // Two platforms joined by two pairs of hinged plates at right angles: the upper one moves only along z.
  Mechanism m;
  m.model.addBody(makeBody("platform", 2, Mat3d::diagonal({0.1, 0.1, 0.2}), {{0, 0, 1.2}, {}}));
  int k = 0;
  for (const Vec3d& out : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}}) {
    const Vec3d low = 0.5 * out, knee = 1.3 * out + Vec3d{0, 0, 0.6}, high = 0.5 * out + Vec3d{0, 0, 1.2};
    const Vec3d axis = cross(Vec3d{0, 0, 1}, out);
    const std::string side = out.x > 0 ? "x" : "y";
    const Mat3d I = Mat3d::diagonal({0.05, 0.05, 0.05});
    const int a = m.model.addBody(makeBody("lower " + side, 1, I, {0.5 * (low + knee), {}}));
    const int b = m.model.addBody(makeBody("upper " + side, 1, I, {0.5 * (knee + high), {}}));
    m.model.addJointAt("foot " + side, JointType::kRevolute, kWorld, a, frameWithZ(low, axis));
    m.model.addJointAt("knee " + side, JointType::kRevolute, a, b, frameWithZ(knee, axis));
    m.model.addJointAt("head " + side, JointType::kRevolute, b, 0, frameWithZ(high, axis));
    ++k;
  }
  m.start();
  expectMoves(m, "Sarrus", 1, 1, 0.7);
  EXPECT_LT(std::fabs(m.state.pose[0].position.x) + std::fabs(m.state.pose[0].position.y), 1e-12);
}

TEST(Overconstrained, RodsOfAPlanarParallelogramByDistanceJoints) {
  // Point masses and rods: a rigid tetrahedron has six rods; a seventh between the same points is redundant.
  Mechanism m;
  const Vec3d p[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int i = 0; i < 4; ++i) {
    Body b = makeBody("point " + std::to_string(i), 1 + i, {}, {p[i], {}});
    b.point = true;
    m.model.addBody(b);
  }
  int rod = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) m.model.addJoint({"rod " + std::to_string(rod++), JointType::kDistance, j, i, {}, {}});
  m.model.addJoint({"spare rod", JointType::kDistance, 0, 3, {}, {}});
  m.start();
  SolverOptions o = rattle();
  o.startVelocities = StartVelocities::kAccept;
  Solver solver(m.model, o);
  EXPECT_EQ(solver.degreesOfFreedom(), 6);
  EXPECT_EQ(solver.redundantRowNames().size(), 1u);
}

TEST(Overconstrained, AStartInLineIsReportedAsSingularAndMovesOn) {
  // A parallelogram folded flat: one more row besides the three redundant ones lacks a pivot, only in this position.
  Mechanism m;
  addRod(m.model, "crank", {0, 0, 0}, {1, 0, 0}, {0, 0, -2.5}, {0, 5, 0});
  addRod(m.model, "rocker", {1, 0, 0}, {2, 0, 0}, {0, 0, -2.5}, {0, 5, 0});
  addRod(m.model, "coupler", {1, 0, 0}, {2, 0, 0}, {0, 0, -5});
  const auto pin = [&](const char* name, int a, int b, const Vec3d& p) {
    m.model.addJointAt(name, JointType::kRevolute, a, b, frameWithZ(p, kY));
  };
  pin("foot 1", kWorld, 0, {}), pin("foot 2", kWorld, 1, {1, 0, 0});
  pin("head 1", 0, 2, {1, 0, 0}), pin("head 2", 1, 2, {2, 0, 0});
  m.start();
  for (const Integrator integrator : {Integrator::kSymplecticEuler, Integrator::kRattle}) {
    m.start();
    SolverOptions o;
    o.integrator = integrator;
    Solver solver(m.model, o);
    EXPECT_EQ(solver.degreesOfFreedom(), 1);
    EXPECT_EQ(solver.redundantRowNames().size(), 3u);
    EXPECT_NE(solver.report().find("singular position"), std::string::npos);
    solver.step(m.state, m.loads, 1e-3);
    EXPECT_EQ(solver.lastStep().singularRows, 1);
    double apart = 0;
    for (int i = 0; i < 3000; ++i) {
      solver.step(m.state, m.loads, 1e-3);
      // It remains a parallelogram: crank and rocker are parallel.
      const Vec3d d = m.state.pose[1].position - m.state.pose[0].position;
      apart = std::max(apart, length(d - Vec3d{1, 0, 0}));
    }
    // Gaps up to the tolerance, over the sine of the angles near the straight line, half a step's 5e-3 rad: 4e-8.
    EXPECT_LT(apart, integrator == Integrator::kRattle ? 1e-11 : 4e-8);
  }
}

TEST(Overconstrained, CouplingsInARingOfThreeGearsThatAgreeAreRedundant) {
  Mechanism m;
  for (int i = 0; i < 3; ++i) {
    m.model.addBody(makeBody("wheel " + std::to_string(i), 1, Mat3d::diagonal({0.1, 0.1, 0.1}), {}));
    m.model.addJointAt("hub " + std::to_string(i), JointType::kRevolute, kWorld, i, {});
  }
  const double ratio[3] = {2, 0.5, 1};
  for (int i = 0; i < 3; ++i) {
    Coupling c;
    c.name = "gear " + std::to_string(i), c.joint1 = i, c.joint2 = (i + 1) % 3, c.ratio = ratio[i];
    m.model.addCoupling(c);
  }
  m.start();
  const Solver solver(m.model, rattle());
  EXPECT_EQ(solver.degreesOfFreedom(), 1);
  EXPECT_EQ(solver.redundantRowNames(), std::vector<std::string>{"coupling 'gear 2'"});
}

} // namespace
} // namespace grouser::multibody::test
