// SPDX-License-Identifier: BSD-3-Clause
#include "mechanisms.hpp"
#include "multibody/detail/constraint_system.hpp"
#include "multibody/detail/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace grouser::multibody::test {
namespace {

using namespace detail;

/// Two bodies in general position, joint frames that do not coincide: the rows' formulas hold open or closed.
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
    if (p.c.kind == ConstraintKind::kPrismatic) C[kAxisRow] = axisPosition(p.c, g);
    if (p.c.kind == ConstraintKind::kPointSpring) C[0] = axisPosition(p.c, g);
  };
  // Central differences with h = 1e-5: truncation h^2 / 6 of third derivatives of order one, round-off 1e-16 / h.
  const double h = 1e-5, tolerance = 2e-10;
  for (int body = 0; body < 2; ++body)
    for (int dof = 0; dof < 6; ++dof) {
      double u[6] = {}, plus[6], minus[6];
      u[dof] = 1;
      values(body == 0 ? moved(p.A, u, h) : p.A, body == 1 ? moved(p.B, u, h) : p.B, plus);
      values(body == 0 ? moved(p.A, u, -h) : p.A, body == 1 ? moved(p.B, u, -h) : p.B, minus);
      const bool revolute = p.c.kind == ConstraintKind::kRevolute;
      for (int r = 0; r < 6; ++r) {
        if (revolute && r == kAxisRow) continue; // its rate equals the angle's only when the axes coincide: next test
        EXPECT_NEAR((body == 0 ? JA : JB)[static_cast<std::size_t>(kStride * dof + r)], (plus[r] - minus[r]) / (2 * h),
                    tolerance)
            << "body " << body << " dof " << dof << " row " << r;
      }
    }
}

TEST_P(MultibodyRows, ForcesOnTheTwoBodiesBalance) {
  // Rigid motions of both bodies together do no work on any row, however open the joint is.
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

INSTANTIATE_TEST_SUITE_P(Kinds, MultibodyRows,
                         ::testing::Values(ConstraintKind::kRevolute, ConstraintKind::kSpherical,
                                           ConstraintKind::kUniversal, ConstraintKind::kPrismatic,
                                           ConstraintKind::kFixed, ConstraintKind::kPointSpring));

TEST(MultibodyAngle, GrowsWithTheRelativeRotationOverManyTurns) {
  Pair p = openPair(ConstraintKind::kRevolute);
  // Close the joint: B's frame onto A's, then turn B about the common axis.
  const Pose X_WJ = compose(p.A, {p.c.point_A, rotationBy({0.1, 0.2, -0.4})});
  p.B = compose(X_WJ, inverse({p.c.point_B, rotationBy({0.3, -0.1, 0.2})}));
  const Vec3d z = rotate(X_WJ.orientation, {0, 0, 1});
  JointFrames f = framesOf(p.c, frameOf(p.A), frameOf(p.B));
  double angle = axisPosition(p.c, f);
  EXPECT_NEAR(angle, 0, 1e-15);
  for (const double increment : {0.003, 1.4}) {
    const int turns = static_cast<int>(40 / increment);
    const double before = angle;
    for (int i = 0; i < turns; ++i) {
      const Quat q = rotationBy(increment * z);
      p.B = {X_WJ.position + rotate(q, p.B.position - X_WJ.position), (q * p.B.orientation).normalized()};
      const JointFrames g = framesOf(p.c, frameOf(p.A), frameOf(p.B));
      angle = axisPositionAfter(p.c, f, g, angle);
      f = g;
    }
    EXPECT_NEAR(angle - before, increment * turns, 1e-11); // round-off of thousands of turns
  }
}

TEST(MultibodyElimination, SolvesTheSaddlePointSystemOfABranchedGraphWithLoops) {
  // A graph with two loops, a star and a world joint, filled with made-up numbers, against the equations themselves.
  const std::vector<Elimination::Edge> edges{{-1, 0}, {0, 1}, {1, 2}, {2, 0}, {2, 3},  {2, 4},
                                             {2, 5},  {5, 6}, {6, 3}, {7, 8}, {8, -1}, {4, 1, true}};
  const int bodies = 9, constraints = static_cast<int>(edges.size()), n = 6 * (bodies + constraints);
  Elimination e(bodies, edges);
  EXPECT_EQ(e.parts().size(), 2u);
  std::vector<std::vector<double>> K(static_cast<std::size_t>(n), std::vector<double>(static_cast<std::size_t>(n), 0));
  const auto entry = [&](int i, int j) -> double& {
    return K[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  };
  unsigned seed = 12345;
  const auto number = [&] {
    seed = seed * 1664525u + 1013904223u;
    return static_cast<double>(seed >> 8) / 16777216.0 - 0.5;
  };
  for (int b = 0; b < bodies; ++b) {
    const double m = 1 + b, I[3][3] = {{2, 0.3, 0.1}, {0.3, 3, 0.2}, {0.1, 0.2, 2.5}};
    const double d = 2 * (3 * 2.5 - 0.04) - 0.3 * (0.75 - 0.02) + 0.1 * (0.06 - 0.3); // I^-1 by cofactors
    const double inverse[3][3] = {{(7.5 - 0.04) / d, (0.02 - 0.75) / d, (0.06 - 0.3) / d},
                                  {(0.02 - 0.75) / d, (5 - 0.01) / d, (0.03 - 0.4) / d},
                                  {(0.06 - 0.3) / d, (0.03 - 0.4) / d, (6 - 0.09) / d}};
    if (e.bodyAlone(b))
      e.setBodyInverse(b, 1 / m, inverse);
    else
      e.setBody(b, m, I);
    for (int i = 0; i < 3; ++i) {
      entry(6 * b + i, 6 * b + i) = m;
      for (int j = 0; j < 3; ++j) entry(6 * b + 3 + i, 6 * b + 3 + j) = I[i][j];
    }
  }
  for (int c = 0; c < constraints; ++c) {
    Block J[2] = {};
    double G[6] = {0, 0, 0.1, 0.2, 0.3, 0.5};
    if (c == 8) G[0] = G[1] = 0.1; // closes a loop that leaves it no freedom
    for (auto& side : J)
      for (std::size_t i = 0; i < 48; ++i)
        if (i % kStride < 6) side[i] = number();
    e.setConstraint(c, J[0], J[1], G, 0x3f);
    const int row = 6 * (bodies + c),
              body[2] = {edges[static_cast<std::size_t>(c)].bodyA, edges[static_cast<std::size_t>(c)].bodyB};
    for (int r = 0; r < 6; ++r) {
      entry(row + r, row + r) = -G[r];
      for (int side = 0; side < 2; ++side)
        for (int i = 0; i < 6 && body[side] >= 0; ++i)
          entry(row + r, 6 * body[side] + i) = entry(6 * body[side] + i, row + r) =
              J[side][static_cast<std::size_t>(kStride * i + r)];
    }
  }
  std::vector<double> rhs(static_cast<std::size_t>(n));
  for (double& b : rhs) b = number();
  std::vector<Vector6> blocks(static_cast<std::size_t>(n / 6));
  for (std::size_t i = 0; i < rhs.size(); ++i) blocks[i / 6][i % 6] = rhs[i];
  for (const auto& part : e.parts()) {
    EXPECT_EQ(e.factor(part), 0);
    e.solve(part, blocks.data());
  }
  std::vector<double> x;
  for (std::size_t i = 0; i < rhs.size(); ++i) x.push_back(blocks[i / 6][i % 6]);
  for (int i = 0; i < n; ++i) {
    double residual = -rhs[static_cast<std::size_t>(i)];
    for (int j = 0; j < n; ++j) residual += entry(i, j) * x[static_cast<std::size_t>(j)];
    EXPECT_NEAR(residual, 0, 1e-10) << i; // round-off times the growth of an LDL^T without pivoting
  }
}

TEST(MultibodyElimination, FillOfARingIsConstantForEachLink) {
  const auto blocks = [](int links) {
    RingSpec spec;
    spec.links = links;
    Model model;
    addRing(model, spec);
    return ConstraintSystem(model).elimination().blocks();
  };
  EXPECT_EQ(blocks(92) - blocks(46), 46 * 4); // two body-joint blocks, two joint-joint blocks a link
  EXPECT_EQ(blocks(184) - blocks(92), 92 * 4);
}

} // namespace
} // namespace grouser::multibody::test
