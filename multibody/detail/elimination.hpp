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
/// solved directly along a spanning tree of joints (spanning_tree.hpp), leaves first. A body b whose joint leaves it
/// the directions s_i of motion relative to its parent (dual to the joint's rows) has
///
///   dv_b = X dv_parent + delta + sum s_i q_i             X: shift of a twist between centres of mass
///   F = I dv_b + L mu - p                                wrench from the joint; L mu: from the loops' constraints
///   s_i . F = c_i / G_i - q_i / G_i                      soft row; 0 on a free axis
///
/// delta = motion imposed by the right-hand sides of the rows. Eliminating the q_i one by one takes rank-one terms from
/// the articulated inertia I, from L and from p (Featherstone 1983; for constraints that close loops Brandl, Johanni
/// and Otter 1986),
///
///   U = I s,  D = s . U + 1/G,   I -= U U^T / D,   L -= U (s . L) / D,   p -= U (s . p + c/G) / D
///
/// and the remainder is passed on to the parent. The loop constraints gather -(G + sum (s.L)(s.L)^T / D); each is
/// eliminated, in blocks, just before its top. Cost: about 250 multiplications a body, and 25 more for each row of a
/// loop that it is part of. A row of a loop constraint whose pivot is below kPivotTolerance of its own J M^-1 J^T
/// depends on others; it is left out (its multiplier is 0). A tree joint always has its pivots.
///
/// Bodies at the same depth are processed four at a time, one per lane. (The two branches of either of a vehicle's two
/// rings fill four lanes.)
class Elimination {
public:
  static constexpr double kPivotTolerance = 1e-11;

  /// Target of a column of L: the parent's column, or the loop constraint's own block at its top.
  struct Onward {
    double* entry = nullptr; ///< null: the world
    int stride = 0;
  };

  /// Up to four bodies with their joints.
  struct alignas(64) Links {
    int count = 0, freedoms = 0, columns = 0;
    bool aligned = false; ///< the parents are the lanes of one batch, in order, and their columns too
    std::array<int, kLanes> body{}, joint{};
    std::array<int, kLanes> parentBatch{}, parentLane{}; ///< -1: none
    std::array<int, kLanes> parentNode{};                ///< body; -1: the world, or nothing
    std::array<int, 3> forceRow{}, torqueRow{};
    std::array<int, 6> freeRow{};
    std::size_t firstColumn = 0, firstPair = 0;

    // Set for each factorisation; rows, arms and distances point from parent to child.
    Lanes mass, inertia[6];
    Vec3L force[3], torque[3];
    Vec3L arm;  ///< p_B - com
    Vec3L away; ///< com - com of the parent
    Lanes inverseCompliance[6], free[6];
    // Articulated inertia: force and torque, of v and w; the symmetric ones by columns of the lower triangle.
    Lanes vv[6], vw[9], ww[6];
    Vec3L dual[3]; ///< of the torque rows
    Lanes s[6][6], u[6][6], inverseD[6];
    // Data of one solution.
    mutable Lanes delta[6], p[6], right[6], residual[6];
  };
  struct alignas(64) Column {
    Lanes l[6]; ///< of L
    Lanes w[6]; ///< s . L, one per degree of freedom
    std::array<Onward, kLanes> onward;
    std::array<int, kLanes> node; ///< of its multiplier
    std::array<int, kLanes> rowOf{};
  };

  Elimination(int bodies, const std::vector<ConstraintEdge>& edges);
  Elimination(const Elimination&) = delete;
  Elimination& operator=(const Elimination&) = delete;

  const SpanningTree& tree() const { return tree_; }
  int batches() const { return static_cast<int>(links_.size()); }
  /// Multiplications of one factorisation and one solution, idle lanes not counted.
  long multiplications() const;

  /// Direct access to the data of setBody() and setJoint(), four at a time.
  Links& links(int batch) { return links_[static_cast<std::size_t>(batch)]; }
  const Links& links(int batch) const { return links_[static_cast<std::size_t>(batch)]; }
  void setBody(int body, double mass, const double (&inertia)[3][3]);
  /// A constraint between two bodies whose row r is a force and a torque on B, the force at `p_B`, the opposite on A.
  /// `compliance`: G. `active`: rows that hold or are soft (bit mask); the others are free.
  void setJoint(int constraint, const RowDirectionsOf<double>& rows, const base::Vec3<double>& p_B,
                const base::Vec3<double>& com_A, const base::Vec3<double>& com_B, const double* compliance,
                unsigned active);
  /// Any other constraint: one block per body of its edge (row = constraint row, column = v, w of the body).
  void setConstraint(int constraint, const Block* jacobians, const double* compliance, unsigned active);

  /// Pivot sizes below which rows of a loop constraint are dropped; tree joints need none.
  void setSmallestPivots(int constraint, const double (&smallest)[6]);
  /// Returns the number of active rows dropped for lack of a pivot.
  int factor();
  /// In: r of each body, then c of each constraint. Out: dv and dLambda.
  void solve(Vector6* x) const;
  /// Active rows kept by the last factorisation (bit mask).
  unsigned keptRows(int constraint) const { return kept_[static_cast<std::size_t>(constraint)]; }

private:
  struct Loop {
    int constraint = 0, top = -1;
    std::vector<int> bodies;
    std::vector<int> neighbours; ///< coupled loops that are eliminated later,
    std::vector<int> slots;      ///< and the blocks of that coupling
    /// Rows of L: at its own bodies, and those of its neighbours at its top.
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
  std::vector<Block> diagonal_, w_, v_; ///< of the loops; and of their couplings
  std::vector<Place> placeOfBody_, placeOfJoint_;
  std::vector<int> loopOf_;         ///< of a constraint; -1: in the tree
  std::vector<signed char> sideOf_; ///< of a tree joint: 1 where the child is B, -1 where it is A
  std::vector<Operation> program_;
  std::vector<unsigned> kept_;
  std::vector<std::vector<std::pair<int, int>>> columnsOf_; ///< of a body: loop and row
};

} // namespace grouser::multibody::detail
