// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/block.hpp"

#include <vector>

namespace grouser::multibody::detail {

/// The symmetric saddle-point system of a mechanism, in 6x6 blocks,
///
///   [ M   J^T ] [ dv ]   [ rBody       ]        M      one block a body (mass, inertia in world axes)
///   [ J  -G   ] [ mu ] = [ rConstraint ]        J      one block a constraint and body it acts on, up to 6 rows
///                                               G      diagonal, >= 0: 0 on hard rows, compliance on soft rows
///
/// solved directly as P L D L^T P^T over the graph whose nodes are bodies and constraints. Nodes 0..bodies-1 are the
/// bodies, then the constraints. The order of elimination is found once (minimum degree under the rule below), then
/// postordered, so that independent parts are contiguous and a ring or chain is walked along: constant fill for each
/// link, cost linear in the links.
///
/// The rule that keeps the pivots from vanishing: along a spanning tree of bodies (from the world, or from the body
/// with the most joints) each joint has a child body. A joint of the tree is eliminated after its child; one that
/// closes a loop after all bodies it is connected with. Then the rows eliminated so far are always independent on the
/// bodies eliminated so far, unless constraints are truly redundant; that shows up as a vanishing pivot in a joint that
/// closes a loop. A row whose pivot is below kPivotTolerance of its own J M^-1 J^T is left out (its multiplier is 0).
class Elimination {
public:
  /// Round-off leaves about 1e-15 of the diagonal where a pivot should be zero; honest pivots of chains with a mass
  /// ratio of 1e6 and hundreds of links stay above 1e-9.
  static constexpr double kPivotTolerance = 1e-11;

  /// A constraint and the bodies it acts on, -1 where that is the world.
  struct Edge {
    int bodyA, bodyB;
    bool soft = false; ///< has no hard rows (a spring): needs no place in the tree
  };

  struct Part {
    int firstStep = 0, endStep = 0; ///< range in the order of elimination
  };

  Elimination(int bodies, const std::vector<Edge>& edges);

  const std::vector<Part>& parts() const { return parts_; }
  const std::vector<int>& order() const { return order_; }       ///< node eliminated at each step
  int blocks() const { return static_cast<int>(slots_.size()); } ///< off-diagonal blocks of the factor, fill included

  /// Whether a body's block is still diag(m, m, m, I) when its turn comes: then it is set by its inverse, the others by
  /// mass and inertia. Inertias in world axes, row-major 3x3.
  bool bodyAlone(int body) const { return alone_[static_cast<std::size_t>(body)]; }
  void setBody(int body, double mass, const double (&inertia)[3][3]);
  void setBodyInverse(int body, double inverseMass, const double (&inverseInertia)[3][3]);
  /// Row blocks of a constraint, of `Block` layout (row = constraint row, column = v, w of the body); null for the
  /// world. `compliance`: G. `active`: bit mask of rows.
  void setConstraint(int constraint, const Block& jacobianA, const Block& jacobianB, const double* compliance,
                     unsigned active);
  /// J M^-1 J^T of each row of a constraint alone, times kPivotTolerance; 0 before it is set.
  void setSmallestPivots(int constraint, const double (&smallest)[6]);

  /// Factors one part. Returns the number of active rows left out for want of a pivot.
  int factor(const Part& part);
  /// Solves in place: `x` holds one vector a node, right-hand side in, solution out.
  void solve(const Part& part, Vector6* x) const;
  /// Rows of a constraint kept by the last factorisation (bit mask).
  unsigned keptRows(int constraint) const { return kept_[static_cast<std::size_t>(bodies_ + constraint)]; }

private:
  struct Slot {
    int row;    ///< node eliminated later
    int column; ///< node eliminated earlier
  };
  struct Update {
    int left, right; ///< slots of the same column: K[target] -= V[left] W[right]^T
    int target;      ///< slot, or ~node for a diagonal block
  };
  struct Step {
    int node;
    int firstSlot, endSlot;
    int firstUpdate, endUpdate;
    bool bodyAlone;
  };
  struct Ends {
    int slotA = -1, slotB = -1; ///< where the row blocks go
    bool transposeA = false, transposeB = false;
  };

  void findOrder(const std::vector<Edge>& edges);
  void postorder(const std::vector<int>& rough);
  void findProgram(const std::vector<Edge>& edges);
  int factorPart(const Part& part);
  void solvePart(const Part& part, Vector6* x) const;

  int bodies_ = 0;
  int nodes_ = 0;
  std::vector<int> order_;
  std::vector<std::vector<int>> laterNeighbours_;
  std::vector<Part> parts_;
  std::vector<Step> steps_;
  std::vector<Slot> slots_;
  std::vector<Update> updates_;
  std::vector<Ends> ends_;
  std::vector<char> isFill_; ///< of each slot: starts as zero

  std::vector<char> alone_;     ///< one a body
  std::vector<Block> diagonal_; ///< one a node; becomes L; inverse of the block for a body alone
  std::vector<Vector6> dInverse_;
  std::vector<Vector6> smallest_;
  std::vector<unsigned> active_, kept_;
  std::vector<Block> w_, v_; ///< one a slot
};

} // namespace grouser::multibody::detail
