// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"
#include "multibody/detail/redundancy.hpp"
#include "multibody/state.hpp"

#include <memory>
#include <vector>

namespace grouser::multibody::detail {

/// Reactions of redundantly constrained joints by the minimum-norm solution.
///
/// With redundant rows the reactions J^T lambda = f are not unique: internal forces n with J^T n = 0 may be added
/// without changing the motion (Wojtyra 2005, Multibody Syst. Dyn. 14:23). The solver drops redundant rows, so that
/// lambda_0 is zero for these rows. The solution computed here minimises
///
///   sum over joints of |F|^2 + |M / L|^2         F, M: force, and moment about the joint's point, of its hard rows
///
/// (a pseudoinverse without a length L would depend on the unit of length: Wojtyra, Pekal and Fraczek 2020, Mech. Mach.
/// Theory 153:103999). With W = 1 for forces and 1 / L for moments,
///
///   lambda = W^-2 J y,   (J^T W^-2 J) y = J^T lambda_0:
///
/// i.e. lambda are the reactions of identical, nearly rigid bearings with stiffness 1 in displacement and L^2 in
/// rotation; y is the displacement of the bodies. L is the spacing of the joints involved: the root mean square of
/// their mutual distances at the model's poses.
///
/// Intended for output; uses its own system and does not change the state.
class ReactionSharing {
public:
  /// `momentLength`: L [m]; 0: the spacing of the joints.
  ReactionSharing(const Model& model, const Redundancy& redundancy, double momentLength);
  ~ReactionSharing();

  /// Replaces the reactions of redundantly constrained joints, given the solver's reactions at `state`, one per joint.
  void share(const State& state, std::vector<JointReaction>& reactions);

private:
  struct Group;
  void addGroups(const Redundancy& redundancy, double momentLength);
  void startGroup(Group& group, const std::vector<JointReaction>& reactions);
  void solveGroup(Group& group);

  ConstraintSystem system_;
  std::vector<AxisLaw> laws_; ///< one per axis: free
  std::vector<Frame> frames_; ///< one per body, the world last
  std::vector<Vector6> x_;    ///< one per node
  std::vector<std::unique_ptr<Group>> groups_;
};

} // namespace grouser::multibody::detail
