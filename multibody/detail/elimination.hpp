// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/block.hpp"
#include "multibody/detail/joint_rows.hpp"
#include "multibody/detail/lanes.hpp"
#include "multibody/detail/spanning_tree.hpp"

#include <array>
#include <vector>

namespace grouser::multibody::detail {

/// The symmetric saddle-point system of a mechanism
///
///   M dv - J^T dLambda = r           M      mass and inertia of each body, twists at the centres of mass, world axes
///   J dv + G dLambda = c             G      diagonal, >= 0: 0 on hard and driven rows, compliance on soft rows
///
/// is solved directly along a spanning tree of joints (spanning_tree.hpp), leaves first. A body b that can move
/// relative to its parent in the directions s_i (dual to the joint's rows) satisfies
///
///   dv_b = X dv_parent + delta + sum s_i q_i             X: shift of a twist between centres of mass
///   F = I dv_b + L mu - p                                wrench of the joint; L mu: of the loop constraints
///   s_i . F = c_i / G_i - q_i / G_i                      soft row; 0 on a free axis
///
/// where delta is the motion imposed by the right-hand sides of the rows. The elimination of each q_i subtracts
/// rank-one terms from the articulated inertia I, from L and from p (Featherstone 1983; for loop-closing constraints
/// Brandl, Johanni and Otter 1986),
///
///   U = I s,  D = s . U + 1/G,   I -= U U^T / D,   L -= U (s . L) / D,   p -= U (s . p + c/G) / D
///
/// and the remainder is added to the parent. The matrix of the loop constraints is -(G + sum (s.L)(s.L)^T / D); each
/// constraint is eliminated, in blocks, just before its top. Cost: about 250 multiplications per body, plus 25 for each
/// row of the loops that contain the body. A row of a loop constraint with a pivot below kPivotTolerance times its own
/// J M^-1 J^T depends on other rows and is dropped (its multiplier is 0). Tree joints always have pivots.
///
/// Bodies at the same depth are processed four at a time, one per lane. (A vehicle's two rings have two branches each,
/// which fill four lanes.)
class Elimination {
public:
  static constexpr double kPivotTolerance = 1e-11;

  /// Destination of a column of L: a column of the parent, or, at the top of a loop constraint, the block of the loop.
  struct Onward {
    double* entry = nullptr; ///< null at the world, which needs no column
    int stride = 0;
  };

  /// Up to four bodies with their joints.
  struct alignas(64) Links {
    int count = 0, freedoms = 0, columns = 0;
    bool aligned = false; ///< the parents and their columns are in one batch, in lane order
    std::array<int, kLanes> body{}, joint{};
    std::array<int, kLanes> parentBatch{}, parentLane{}; ///< -1: none
    std::array<int, kLanes> parentNode{};                ///< body; -1: the world or no parent
    std::array<int, 3> forceRow{}, torqueRow{};
    std::array<int, 6> freeRow{};
    std::size_t firstColumn = 0, firstPair = 0;

    // Set by each factorisation; rows, arms and distances point from parent to child.
    Lanes mass, inertia[6];
    Vec3L force[3], torque[3];
    Vec3L arm;  ///< p_B - com
    Vec3L away; ///< com - com of the parent
    Lanes inverseCompliance[6], free[6];
    // Articulated inertia: force and torque over v and w; symmetric blocks by columns of the lower triangle.
    Lanes vv[6], vw[9], ww[6];
    Vec3L dual[3]; ///< dual vectors of the torque rows
    Lanes s[6][6], u[6][6], inverseD[6];
    // Data of one solution.
    mutable Lanes delta[6], p[6], right[6], residual[6];
  };
  struct alignas(64) Column {
    Lanes l[6]; ///< column of L
    Lanes w[6]; ///< s . L, one per degree of freedom
    std::array<Onward, kLanes> onward;
    std::array<int, kLanes> node; ///< node of the multiplier
    std::array<int, kLanes> rowOf{};
  };

  Elimination(int bodies, const std::vector<ConstraintEdge>& edges);
  Elimination(const Elimination&) = delete;
  Elimination& operator=(const Elimination&) = delete;

  const SpanningTree& tree() const { return tree_; }
  int batches() const { return static_cast<int>(links_.size()); }
  /// Multiplications of one factorisation and one solution, idle lanes not counted.
  long multiplications() const;

  /// Direct access to the values that setBody() and setJoint() set, four lanes at a time.
  Links& links(int batch) { return links_[static_cast<std::size_t>(batch)]; }
  const Links& links(int batch) const { return links_[static_cast<std::size_t>(batch)]; }
  void setBody(int body, double mass, const double (&inertia)[3][3]);
  /// Sets a constraint between two bodies. Row r is a force at `p_B` and a torque on B, and the opposite on A.
  /// `compliance`: G. `active`: bit mask of hard and soft rows; the others are free.
  void setJoint(int constraint, const RowDirectionsOf<double>& rows, const base::Vec3<double>& p_B,
                const base::Vec3<double>& com_A, const base::Vec3<double>& com_B, const double* compliance,
                unsigned active);
  /// Sets any other constraint: one block per body of its edge (row = constraint row, column = v, w of the body).
  void setConstraint(int constraint, const Block* jacobians, const double* compliance, unsigned active);

  /// Sets the pivot sizes below which rows of a loop constraint are dropped; not used for tree joints.
  void setSmallestPivots(int constraint, const double (&smallest)[6]);
  /// Factors the system. Returns the number of active rows dropped for lack of a pivot.
  int factor();
  /// Solves in place. In: r of each body, then c of each constraint. Out: dv and dLambda.
  void solve(Vector6* x) const;
  /// Active rows kept by the last factorisation (bit mask).
  unsigned keptRows(int constraint) const { return kept_[static_cast<std::size_t>(constraint)]; }

private:
  struct Loop {
    int constraint = 0, top = -1;
    std::vector<int> bodies;
    std::vector<int> neighbours; ///< coupled loops eliminated later
    std::vector<int> slots;      ///< blocks of these couplings
    /// Targets for the rows of L: at the loop's own bodies, and at its top for its neighbours.
    std::vector<std::array<Onward, 6>> entries, onto;
    std::vector<Block> jacobians;
    Block atTop{}, vTop{};
    Vector6 dInverse{}, smallest{};
    std::array<double, 6> compliance{};
    unsigned active = 0;
  };
  struct Place {
    int batch = -1, lane = 0;
  };
  struct Operation {
    bool closes;
    int index;
  };

  void makeBatches(const std::vector<ConstraintEdge>& edges);
  void addBatch(const std::vector<int>& bodies, const std::vector<ConstraintEdge>& edges);
  void makeColumns();
  void makeLoops(const std::vector<ConstraintEdge>& edges);
  bool parentsAligned(const Links& links) const;
  void linkColumns(Links& links);
  double* productOf(int body, int column, int other);
  void makeProgram();
  Onward columnAt(int body, int loop, int row);
  int slotOf(int later, int earlier) const;

  void startLoops();
  int sweep();
  int factorLoop(Loop& z);
  void sweepForward(Vector6* x) const;
  void sweepBackward(Vector6* x) const;
  void forwardLoop(const Loop& z, Vector6* x) const;
  void backwardLoop(const Loop& z, Vector6* x) const;

  int bodies_ = 0;
  SpanningTree tree_;
  std::vector<Links> links_;
  std::vector<Column> columns_;
  std::vector<double*> pairs_;
  std::vector<Loop> loops_;
  std::vector<Block> diagonal_, w_, v_; ///< diagonal_: one block per loop; w_, v_: one per coupling
  std::vector<Place> placeOfBody_, placeOfJoint_;
  std::vector<int> loopOf_;         ///< per constraint: index of its loop; -1: in the tree
  std::vector<signed char> sideOf_; ///< per tree joint: 1 if the child is B, -1 if it is A
  std::vector<Operation> program_;
  std::vector<unsigned> kept_;
  std::vector<std::vector<std::pair<int, int>>> columnsOf_; ///< per body: loop and row of each column
};

} // namespace grouser::multibody::detail
