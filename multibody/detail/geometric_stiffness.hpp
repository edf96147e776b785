// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"
#include "multibody/detail/soft_rows.hpp"

#include <vector>

namespace grouser::multibody::detail {

/// Forces and torques along all rows of each constraint [N, N m]: multipliers, springs, drives and couplings together.
using Pull = std::vector<Vector6>;

/// Fills the pull of one part, linearised at the state's poses (`frames`): what its joints bear there.
void findPull(const ConstraintSystem& system, const Model& model, const ConstraintSystem::Part& part,
              const std::vector<Frame>& frames, const State& state, const Loads& loads, const SoftRows& softRows,
              std::vector<Vector6>& x, Pull& pull);

/// Square of the fastest rate [rad2/s2] at which the pull of what joins them moves the bodies of one part, at the poses
/// of its last linearise(): a taut chain or spring lets them swing across it, a pressed one lets them fall to the side.
/// `constraint`: the one with the greatest part in it, -1 where nothing pulls.
double fastestOnPull(const ConstraintSystem& system, const Model& model, const ConstraintSystem::Part& part,
                     const std::vector<Pose>& poses, const Pull& pull, std::vector<Vector6>& x, int& constraint);

} // namespace grouser::multibody::detail
