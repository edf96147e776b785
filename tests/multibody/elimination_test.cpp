// SPDX-License-Identifier: BSD-3-Clause
#include "mechanisms.hpp"
#include "multibody/detail/constraint.hpp"
#include "multibody/detail/elimination.hpp"
#include "multibody/detail/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace grouser::multibody::test {
namespace {

using namespace detail;

ConstraintEdge joint(int bodyA, int bodyB, unsigned hard = 0x1f, unsigned forceRows = 7) {
  ConstraintEdge edge;
  edge.bodies = {bodyA, bodyB}, edge.joint = true, edge.hard = hard, edge.forceRows = forceRows;
  return edge;
}
ConstraintEdge other(std::vector<int> bodies) {
  ConstraintEdge edge;
  edge.bodies = std::move(bodies);
  return edge;
}

/// A saddle-point system with synthetic numbers on a given graph, in the solver and as a dense matrix.
struct MadeUpSystem {
  MadeUpSystem(int bodyCount, std::vector<ConstraintEdge> graph)
      : bodies(bodyCount), edges(std::move(graph)), e(bodies, edges),
        n(6 * (static_cast<std::size_t>(bodies) + edges.size())), K(n * n, 0.0) {
    for (int b = 0; b < bodies; ++b) addBody(b);
  }

  double& entry(std::size_t i, std::size_t j) { return K[n * i + j]; }

  double number() {
    seed = seed * 1664525u + 1013904223u;
    return static_cast<double>(seed >> 8) / 16777216.0 - 0.5;
  }
  Vec3d vector() {
    const double x = number(), y = number();
    return {x, y, number()};
  }

  void addBody(int b) {
    com.push_back(vector());
    const double m = 1 + b, I[3][3] = {{2, 0.3, 0.1}, {0.3, 3, 0.2}, {0.1, 0.2, 2.5}};
    e.setBody(b, m, I);
    const std::size_t first = 6 * static_cast<std::size_t>(b);
    for (std::size_t i = 0; i < 3; ++i) {
      entry(first + i, first + i) = m;
      for (std::size_t j = 0; j < 3; ++j) entry(first + 3 + i, first + 3 + j) = I[i][j];
    }
  }

  void addRows(int c, const std::vector<Block>& J, const double (&G)[6], unsigned active) {
    const std::size_t row = 6 * static_cast<std::size_t>(bodies + c);
    for (std::size_t r = 0; r < 6; ++r) {
      if (!(active >> r & 1u)) continue;
      entry(row + r, row + r) = -G[r];
      for (std::size_t side = 0; side < J.size(); ++side) {
        const int body = edges[static_cast<std::size_t>(c)].bodies[side];
        for (std::size_t i = 0; i < 6 && body >= 0; ++i) {
          const std::size_t column = 6 * static_cast<std::size_t>(body) + i;
          entry(row + r, column) = entry(column, row + r) = J[side][kStride * i + r];
        }
      }
    }
  }

  /// Forces along the axes of a frame, torques about three arbitrary axes.
  void addJoint(int c, const double (&G)[6], unsigned active) {
    const ConstraintEdge& edge = edges[static_cast<std::size_t>(c)];
    const Mat3d R = rotationBy(3.0 * vector()).normalized().matrix();
    RowDirections rows;
    int column = 0;
    for (unsigned r = 0; r < 6; ++r)
      if (edge.forceRows >> r & 1u) {
        rows.force[r] = {R.m[0][column], R.m[1][column], R.m[2][column]};
        ++column;
      } else {
        rows.torque[r] = vector();
      }
    const auto centre = [&](int body) { return body < 0 ? Vec3d{} : com[static_cast<std::size_t>(body)]; };
    const Vec3d p = vector(), com_A = centre(edge.bodies[0]), com_B = centre(edge.bodies[1]);
    e.setJoint(c, rows, p, com_A, com_B, G, active);
    std::vector<Block> J(2, Block{});
    rowBlocks(rows, p, com_A, com_B, J[0], J[1]);
    addRows(c, J, G, active);
  }

  /// Full rows of random numbers for the rows of the mask.
  void addOther(int c, const double (&G)[6], unsigned active) {
    std::vector<Block> J(edges[static_cast<std::size_t>(c)].bodies.size(), Block{});
    for (Block& side : J)
      for (std::size_t i = 0; i < 48; ++i)
        if (i % kStride < 6 && (active >> (i % kStride) & 1u)) side[i] = number();
    e.setConstraint(c, J.data(), G, active);
    addRows(c, J, G, active);
  }

  /// Largest residual of the solution for a random right-hand side (zero in inactive rows).
  double residual() {
    std::vector<Vector6> x(n / 6);
    std::vector<double> rhs(n);
    for (std::size_t i = 0; i < n; ++i) {
      bool empty = true;
      for (std::size_t j = 0; j < n; ++j) empty = empty && entry(i, j) == 0;
      x[i / 6][i % 6] = rhs[i] = empty ? 0 : number();
    }
    EXPECT_EQ(e.factor(), 0);
    e.solve(x.data());
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i) {
      double sum = -rhs[i];
      // The unknown of the matrix is -dLambda.
      for (std::size_t j = 0; j < n; ++j)
        sum += entry(i, j) * (static_cast<int>(j / 6) < bodies ? 1 : -1) * x[j / 6][j % 6];
      if (!(std::fabs(sum) <= worst)) worst = std::fabs(sum);
    }
    return worst;
  }

  int bodies;
  std::vector<ConstraintEdge> edges;
  Elimination e;
  std::size_t n;
  std::vector<double> K;
  std::vector<Vec3d> com;
  unsigned seed = 12345;
};

// Residual bounds are round-off times the growth of an elimination without pivoting, for systems of size one.

TEST(MultibodyElimination, SolvesATreeOfAllKindsOfJoints) {
  // Two trees, one on the world: fixed, revolute, universal, spherical, prismatic, cylindrical; a three-way branch.
  MadeUpSystem s(9, {joint(-1, 0, 0x3f), joint(0, 1), joint(2, 1, 0x0f), joint(1, 3, 0x07), joint(1, 4, 0x1f, 0x23),
                     joint(4, 5, 0x0f, 0x23), joint(6, 7), joint(8, 7)});
  EXPECT_EQ(s.e.tree().independent, 2);
  EXPECT_TRUE(s.e.tree().loops.empty());
  for (int c = 0; c < 8; ++c) s.addJoint(c, {}, s.edges[static_cast<std::size_t>(c)].hard);
  EXPECT_LT(s.residual(), 1e-12);
}

TEST(MultibodyElimination, SolvesSoftAndDrivenAxes) {
  MadeUpSystem s(5, {joint(-1, 0), joint(0, 1), joint(1, 2, 0x07), joint(1, 3), joint(3, 4, 0x0f)});
  s.addJoint(0, {0, 0, 0, 0, 0, 0.4}, 0x3f);
  s.addJoint(1, {0, 0, 0, 0, 0, 0}, 0x3f);   // driven
  s.addJoint(2, {0, 0, 0, 0.3, 0, 7}, 0x2f); // one soft, one free, one soft
  s.addJoint(3, {0, 0, 0, 0, 0, 0}, 0x1f);
  s.addJoint(4, {0, 0, 0, 0, 0.1, 0}, 0x3f); // one soft, one driven
  EXPECT_LT(s.residual(), 1e-12);
}

TEST(MultibodyElimination, SolvesABranchedGraphWithLoopsSpringsAndTwoParts) {
  // All but the first rows are soft, so that no loop has more rows than degrees of freedom.
  MadeUpSystem s(9, {joint(-1, 0, 0x01), joint(0, 1, 0x01), joint(1, 2, 0x01), joint(2, 0, 0x01), joint(2, 3, 0x01),
                     joint(2, 4, 0x01), joint(2, 5, 0x01), joint(5, 6, 0x01), joint(6, 3, 0x01), joint(7, 8, 0x01),
                     joint(8, -1, 0x01), other({4, 1}), other({6, -1}), other({3, 4, 5, 8})});
  EXPECT_EQ(s.e.tree().independent, 1) << "the last constraint joins the parts";
  for (int c = 0; c < 11; ++c) s.addJoint(c, {0, 0.3, 0.1, 0.2, 0.3, 0.5}, 0x3f);
  s.addOther(11, {0.4, 0, 0, 0, 0, 0}, 0x01);
  s.addOther(12, {0.4, 0.3, 0.2, 0.2, 0.5, 0.6}, 0x3f);
  s.addOther(13, {0, 0, 0, 0, 0, 0}, 0x01);
  EXPECT_LT(s.residual(), 1e-12);
}

TEST(MultibodyElimination, SolvesNestedAndNeighbouringLoops) {
  // A ladder of four windows on a free rail: the top of each loop is in the previous one.
  std::vector<ConstraintEdge> graph;
  for (int i = 0; i < 4; ++i)
    for (const auto& [a, b] :
         {std::pair{3 * i, 3 * i + 1}, {3 * i, 3 * i + 2}, {3 * i + 1, 3 * i + 3}, {3 * i + 2, 3 * i + 3}})
      graph.push_back(joint(a, b, 0x0f));
  graph.push_back(joint(12, 5, 0x07));
  graph.push_back(joint(11, 0, 0x07));
  MadeUpSystem s(13, graph);
  EXPECT_EQ(s.e.tree().loops.size(), 6u);
  for (int c = 0; c < static_cast<int>(graph.size()); ++c)
    s.addJoint(c, {0, 0, 0, 0, 0, 0.2}, graph[static_cast<std::size_t>(c)].hard | (c % 2 ? 0x20u : 0u));
  EXPECT_LT(s.residual(), 1e-10);
}

TEST(MultibodyElimination, SolvesHardLoopsBetweenTwoBusyBodies) {
  // Two loops through bodies 0 and 1, five hard rows per joint: rows are independent only with both loops eliminated.
  MadeUpSystem s(8, {joint(0, 1, 0x07), joint(0, 2), joint(2, 3, 0x07), joint(3, 1), joint(0, 4), joint(4, 5, 0x07),
                     joint(5, 1), joint(6, 7)});
  for (int c = 0; c < 8; ++c) s.addJoint(c, {}, s.edges[static_cast<std::size_t>(c)].hard);
  EXPECT_LT(s.residual(), 1e-10);
}

TEST(MultibodyElimination, SolvesFreeBodiesThatOnlyRodsHold) {
  MadeUpSystem s(5, {other({-1, 0}), other({0, 1}), other({1, 2}), other({3, 2}), joint(3, 4)});
  for (int c = 0; c < 4; ++c) s.addOther(c, {}, 0x01);
  s.addJoint(4, {}, 0x1f);
  EXPECT_LT(s.residual(), 1e-11);
}

TEST(MultibodyElimination, MoreBodiesThanLanesOnOneParent) {
  std::vector<ConstraintEdge> graph;
  for (int b = 1; b < 12; ++b) graph.push_back(joint(b % 3 ? 0 : b, b % 3 ? b : 0, b % 2 ? 0x1fu : 0x07u));
  MadeUpSystem s(12, graph);
  for (int c = 0; c < 11; ++c) s.addJoint(c, {}, graph[static_cast<std::size_t>(c)].hard);
  EXPECT_LT(s.residual(), 1e-12);
}

TEST(MultibodyElimination, DoublyHeldRowsAreLeftOutAndTheRestIsSolved) {
  // The same bar twice between bodies 0 and 1, in different directions of elimination.
  MadeUpSystem s(2, {joint(0, 1, 0x1f), other({0, 1}), other({0, 1})});
  s.addJoint(0, {}, 0x1f);
  s.addOther(1, {}, 0x01);
  std::vector<Block> J(2, Block{});
  const std::size_t row = 6 * 3;
  for (std::size_t i = 0; i < 6; ++i) J[0][kStride * i] = s.entry(row, i), J[1][kStride * i] = s.entry(row, 6 + i);
  s.e.setConstraint(2, J.data(), std::array<double, 6>{}.data(), 0x01);
  // Round-off of products of size one.
  for (const int c : {1, 2}) s.e.setSmallestPivots(c, {1e-11, 1e-11, 1e-11, 1e-11, 1e-11, 1e-11});
  EXPECT_EQ(s.e.factor(), 1);
  EXPECT_EQ(s.e.keptRows(1) + s.e.keptRows(2), 1u);
}

/// A ring of `links` bodies, one joint of it spherical.
std::vector<ConstraintEdge> ring(int links) {
  std::vector<ConstraintEdge> graph;
  for (int i = 0; i < links; ++i) graph.push_back(joint(i, (i + 1) % links, i ? 0x1fu : 0x07u));
  for (ConstraintEdge& edge : graph) edge.rows = edge.hard;
  return graph;
}

TEST(MultibodyElimination, WorkForARingIsLinearInItsLinks) {
  const auto work = [](int links) { return Elimination(links, ring(links)).multiplications(); };
  const long w46 = work(46), w92 = work(92), w184 = work(184);
  EXPECT_EQ(w184 - w92, 2 * (w92 - w46)); // exactly linear
  EXPECT_LT((w92 - w46) / 46, 700) << "multiplications per link, factorisation and one solution";
}

TEST(MultibodyElimination, ARingIsTakenApartOppositeItsWeakestJoint) {
  const Elimination e(46, ring(46));
  ASSERT_EQ(e.tree().loops.size(), 1u);
  EXPECT_EQ(e.tree().loops[0].constraint, 0);
  EXPECT_EQ(e.tree().loops[0].path.size(), 45u);
  // Two branches of 22 and 23 links side by side, and the root.
  EXPECT_EQ(e.batches(), 24);
}

} // namespace
} // namespace grouser::multibody::test
