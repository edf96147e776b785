// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint.hpp"
#include "multibody/detail/elimination.hpp"
#include "multibody/state.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace grouser::multibody::detail {

/// What acts along the free axis of a joint, or along a point spring, in one step (axis_laws.hpp).
struct AxisLaw {
  double force = 0;          ///< applied along the row as a known force [N, N m]
  double known = 0;          ///< springs' and stops' part of it that does not depend on the new rate
  double softness = 0;       ///< dt c + dt^2 k of all dampers and springs; 0: no soft row
  double dampingPart = 0;    ///< dt c of all dampers
  double springKnown = 0;    ///< `known`, and
  double springSoftness = 0; ///< `softness` without the joint's own damping
  bool driven = false;
  double speed = 0; ///< imposed rate
};

/// The mechanism linearised at given poses: rows, masses and their factorisation. Knows nothing of time integration:
/// integrators ask it for position errors and for solutions of
///   M dv - J^T dLambda = bodyResidual,   J dv + G dLambda = rowResidual.
class ConstraintSystem {
public:
  explicit ConstraintSystem(const Model& model);

  const Elimination& elimination() const { return *elimination_; }
  const std::vector<Constraint>& constraints() const { return constraints_; }
  int movableBodies() const { return static_cast<int>(movable_.size()); }
  int bodyOf(int node) const { return movable_[static_cast<std::size_t>(node)]; } ///< model's index of a movable body

  struct Part {
    Elimination::Part steps;
    std::vector<int> bodies; ///< movable bodies (nodes)
    std::vector<int> constraints;
  };
  const std::vector<Part>& parts() const { return parts_; }

  /// Hard rows in use: those of the kind without the redundant ones.
  unsigned hardRowsOf(int constraint) const { return hard_[static_cast<std::size_t>(constraint)]; }
  void dropRow(int constraint, int row) { hard_[static_cast<std::size_t>(constraint)] &= ~(1u << row); }

  /// Frames of all bodies at `poses`, the world last.
  void place(const std::vector<Pose>& poses, std::vector<Frame>& frames) const;
  void placeBody(int body, const Pose& pose, std::vector<Frame>& frames) const;

  /// Sets up and factors one part at `frames`. `laws`: one a constraint. Returns the rows left out as singular.
  int linearise(const Part& part, const std::vector<Frame>& frames, const std::vector<AxisLaw>& laws);

  /// In: one vector a node (bodies: momentum residual; constraints: row residual). Out: dv and dLambda.
  void solve(const Part& part, std::vector<Vector6>& x) const;

  /// Quantities of the last linearise().
  const RowDirections& rows(int constraint) const { return rows_[static_cast<std::size_t>(constraint)]; }
  const JointFrames& jointFrames(int constraint) const { return frames_[static_cast<std::size_t>(constraint)]; }
  const Mat3d& inertia(int node) const { return inertia_[static_cast<std::size_t>(node)]; }
  unsigned activeRows(int constraint) const { return active_[static_cast<std::size_t>(constraint)]; }
  /// Rate of one row: J (v, w).
  double rate(int constraint, int row, const std::vector<Twist>& twist) const;

  /// "joint 'pin 7': rotation about x".
  std::string describe(int constraint, int row) const;

private:
  void setSize(int constraint, const Block& jacobianA, const Block& jacobianB);

  const Model* model_;
  std::vector<int> movable_;
  std::vector<Constraint> constraints_;
  std::vector<Part> parts_;
  std::unique_ptr<Elimination> elimination_;
  std::vector<unsigned> hard_, active_;
  std::vector<RowDirections> rows_;
  std::vector<JointFrames> frames_;
  std::vector<Mat3d> inertia_, inverseInertia_; ///< in world axes; inverse in the body's own
  std::vector<char> sized_;                     ///< of each constraint: its smallest pivots are set
  std::vector<Vec3d> com_A_, com_B_;
};

/// A redundant row and what implies it, found at set-up.
struct Redundancy {
  std::vector<std::pair<int, int>> rows; ///< constraint, row: dropped
  int singularAtStart = 0;               ///< rows without pivot only at the starting poses: a singular position
};

/// Finds the hard rows that others imply wherever the mechanism goes: moves it a little along motions its
/// constraints allow (the starting velocities, then generic ones), closes the constraints again by Newton's method, and
/// takes the rows without pivot there. A row that is dependent only at the starting poses (a folded four-bar) is kept.
Redundancy findRedundantRows(ConstraintSystem& system, const Model& model);

} // namespace grouser::multibody::detail
