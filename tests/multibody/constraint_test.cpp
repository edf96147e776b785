// SPDX-License-Identifier: BSD-3-Clause
#include "mechanisms.hpp"
#include "multibody/detail/constraint_system.hpp"
#include "multibody/detail/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace grouser::multibody::test {
namespace {

using namespace detail;

/// Two bodies in general position, with joint frames apart: the rows' formulas hold for open and closed joints.
struct Pair {
  Constraint c{};
  Pose A, B;
};

Pair openPair(ConstraintKind kind) {
  Pair p;
  p.A = {{0.3, -0.2, 0.5}, rotationBy({0.4, -0.3, 0.7})};
  p.B = {{0.9, 0.4, -0.1}, rotationBy({-0.2, 0.5, 0.6})};
  p.c.kind = kind;
  p.c.axes_A = rotationBy({0.1, 0.2, -0.4}).matrix();
  p.c.axes_B = rotationBy({0.3, -0.1, 0.2}).matrix();
  p.c.point_A = {0.2, 0.3, -0.1};
  p.c.point_B = {-0.3, 0.1, 0.25};
  p.c.length = 0.7;
  return p;
}

Frame frameOf(const Pose& X) { return {X.orientation.matrix(), X.position}; }

Pose moved(const Pose& X, const double (&u)[6], double h) {
  return {X.position + h * Vec3d{u[0], u[1], u[2]}, rotationBy(h * Vec3d{u[3], u[4], u[5]}) * X.orientation};
}

class MultibodyRows : public ::testing::TestWithParam<ConstraintKind> {};

TEST_P(MultibodyRows, JacobianIsTheDerivativeOfTheConstraint) {
  const Pair p = openPair(GetParam());
  const Frame FA = frameOf(p.A), FB = frameOf(p.B);
  const JointFrames f = framesOf(p.c, FA, FB);
  Block JA{}, JB{};
  rowBlocks(rowDirections(p.c, f), f.p_B, FA.p, FB.p, JA, JB);

  const auto values = [&](const Pose& A, const Pose& B, double(&C)[6]) {
    const JointFrames g = framesOf(p.c, frameOf(A), frameOf(B));
    positionError(p.c, g, C);
    if (p.c.kind == ConstraintKind::kPrismatic) C[kAxisRow] = axisPosition(p.c, g, kAxisRow);
    if (p.c.kind == ConstraintKind::kPointSpring) C[0] = axisPosition(p.c, g, 0);
    if (p.c.kind == ConstraintKind::kCylindrical) C[kSlideRow] = axisPosition(p.c, g, kSlideRow);
    if (p.c.kind == ConstraintKind::kBushing)
      for (int r = 0; r < 6; ++r) C[r] = axisPosition(p.c, g, r);
  };
  // Central differences with h = 1e-5: truncation h^2 / 6 of third derivatives of order one, round-off 1e-16 / h.
  const double h = 1e-5, tolerance = 2e-10;
  for (int body = 0; body < 2; ++body)
    for (int dof = 0; dof < 6; ++dof) {
      double u[6] = {}, plus[6], minus[6];
      u[dof] = 1;
      values(body == 0 ? moved(p.A, u, h) : p.A, body == 1 ? moved(p.B, u, h) : p.B, plus);
      values(body == 0 ? moved(p.A, u, -h) : p.A, body == 1 ? moved(p.B, u, -h) : p.B, minus);
      const bool revolute = p.c.kind == ConstraintKind::kRevolute || p.c.kind == ConstraintKind::kCylindrical;
      for (int r = 0; r < 6; ++r) {
        if (!((hardRows(p.c.kind) | axisRows(p.c.kind)) >> r & 1u)) continue; // a direction without a law
        if (revolute && r == kAxisRow) continue; // its rate equals the angle's only when the axes coincide: next test
        EXPECT_NEAR((body == 0 ? JA : JB)[static_cast<std::size_t>(kStride * dof + r)], (plus[r] - minus[r]) / (2 * h),
                    tolerance)
            << "body " << body << " dof " << dof << " row " << r;
      }
    }
}

TEST_P(MultibodyRows, ForcesOnTheTwoBodiesBalance) {
  // Rigid motions of both bodies together do no work on any row, even if the joint is open.
  const Pair p = openPair(GetParam());
  const Frame FA = frameOf(p.A), FB = frameOf(p.B);
  const JointFrames f = framesOf(p.c, FA, FB);
  Block JA{}, JB{};
  rowBlocks(rowDirections(p.c, f), f.p_B, FA.p, FB.p, JA, JB);
  const Vec3d w{0.3, -0.8, 0.5}, v{1, 2, 3};
  const Vec3d vA = v + cross(w, FA.p), vB = v + cross(w, FB.p);
  const double uA[6] = {vA.x, vA.y, vA.z, w.x, w.y, w.z}, uB[6] = {vB.x, vB.y, vB.z, w.x, w.y, w.z};
  for (std::size_t r = 0; r < 6; ++r) {
    double rate = 0;
    for (std::size_t i = 0; i < 6; ++i) rate += JA[kStride * i + r] * uA[i] + JB[kStride * i + r] * uB[i];
    EXPECT_NEAR(rate, 0, 1e-14) << "row " << r; // round-off of a dozen terms of order one
  }
}

TEST_P(MultibodyRows, BiasIsTheDerivativeOfTheRatesWithoutAccelerations) {
  const Pair p = openPair(GetParam());
  if (p.c.kind == ConstraintKind::kPointSpring || p.c.kind == ConstraintKind::kBushing) return; // never hard
  const double uA[6] = {0.3, -0.5, 0.2, 0.7, -0.4, 0.6}, uB[6] = {-0.1, 0.4, 0.8, -0.3, 0.9, 0.5};
  const Twist V_A{{uA[0], uA[1], uA[2]}, {uA[3], uA[4], uA[5]}}, V_B{{uB[0], uB[1], uB[2]}, {uB[3], uB[4], uB[5]}};
  // Rates J(q(t)) (v, w) along motions of constant twists.
  const auto rates = [&](double t, double(&rate)[6]) {
    const Frame FA = frameOf(moved(p.A, uA, t)), FB = frameOf(moved(p.B, uB, t));
    const JointFrames f = framesOf(p.c, FA, FB);
    Block JA{}, JB{};
    rowBlocks(rowDirections(p.c, f), f.p_B, FA.p, FB.p, JA, JB);
    for (std::size_t r = 0; r < 6; ++r) {
      rate[r] = 0;
      for (std::size_t i = 0; i < 6; ++i) rate[r] += JA[kStride * i + r] * uA[i] + JB[kStride * i + r] * uB[i];
    }
  };
  const Frame FA = frameOf(p.A), FB = frameOf(p.B);
  double bias[6], plus[6], minus[6];
  rowBias(p.c, framesOf(p.c, FA, FB), FA, FB, V_A, V_B, bias);
  const double h = 1e-5; // central differences: h^2 / 6 of third derivatives of up to some tens (a short rod)
  rates(h, plus), rates(-h, minus);
  const unsigned used = hardRows(p.c.kind) | axisRows(p.c.kind);
  for (int r = 0; r < 6; ++r)
    if (used >> r & 1u) {
      EXPECT_NEAR(bias[r], (plus[r] - minus[r]) / (2 * h), 1e-9) << "row " << r;
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, MultibodyRows,
                         ::testing::Values(ConstraintKind::kRevolute, ConstraintKind::kSpherical,
                                           ConstraintKind::kUniversal, ConstraintKind::kPrismatic,
                                           ConstraintKind::kFixed, ConstraintKind::kCylindrical,
                                           ConstraintKind::kDistance, ConstraintKind::kPointSpring,
                                           ConstraintKind::kBushing));

TEST(MultibodyAngle, GrowsWithTheRelativeRotationOverManyTurns) {
  Pair p = openPair(ConstraintKind::kRevolute);
  // Closes the joint: B's frame onto A's, then turns B about the common axis.
  const Pose X_WJ = compose(p.A, {p.c.point_A, rotationBy({0.1, 0.2, -0.4})});
  p.B = compose(X_WJ, inverse({p.c.point_B, rotationBy({0.3, -0.1, 0.2})}));
  const Vec3d z = rotate(X_WJ.orientation, {0, 0, 1});
  JointFrames f = framesOf(p.c, frameOf(p.A), frameOf(p.B));
  double angle = axisPosition(p.c, f, kAxisRow);
  EXPECT_NEAR(angle, 0, 1e-15);
  for (const double increment : {0.003, 1.4}) {
    const int turns = static_cast<int>(40 / increment);
    const double before = angle;
    for (int i = 0; i < turns; ++i) {
      const Quat q = rotationBy(increment * z);
      p.B = {X_WJ.position + rotate(q, p.B.position - X_WJ.position), (q * p.B.orientation).normalized()};
      const JointFrames g = framesOf(p.c, frameOf(p.A), frameOf(p.B));
      angle = axisPositionAfter(p.c, f, g, kAxisRow, angle);
      f = g;
    }
    EXPECT_NEAR(angle - before, increment * turns, 1e-11); // round-off of thousands of turns
  }
}

TEST(MultibodyRotation, DiscreteSpinMomentumIsTheSameAtBothEndsOfAStep) {
  // The inertia rotates with the body by exp(dt w); backwards in time dt changes sign.
  const Mat3d R = rotationBy({0.4, -0.3, 0.7}).matrix(), I = rotatedInertia(R, Mat3d::diagonal({1, 2, 3 - 1e-3}));
  const Vec3d w{0.7, -1.1, 0.4};
  for (const double dt : {1e-3, 0.1, 0.3, 1.0, 1.8}) {
    const Mat3d turned = rotatedInertia(rotationBy(dt * w).matrix(), I);
    const Vec3d before = I * w + gyroscopicMomentum(I, w, dt), after = turned * w + gyroscopicMomentum(turned, w, -dt);
    EXPECT_LT(length(after - before), 1e-14 * length(before) * 10) << dt; // round-off of a few dozen operations
  }
}

} // namespace
} // namespace grouser::multibody::test
