// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"
#include "multibody/detail/soft_rows.hpp"

#include <vector>

namespace grouser::multibody::detail {

/// Solves for accelerations and multipliers lambda of one part, linearised at `frames`, directly from the
/// differential-algebraic equations, so that reactions contain no time-integration error:
///   M a - J^T lambda = f - (0, w x I w),   J a = imposed acceleration - J' v.
/// `force`: forces of springs, dampers, stops and force drives along each axis, part of f. `x`: one vector per node;
/// returns a and lambda.
void solveReactions(const ConstraintSystem& system, const Model& model, const ConstraintSystem::Part& part,
                    const std::vector<Frame>& frames, const State& state, const Loads& loads,
                    const std::vector<SoftRow>& soft, const std::vector<double>& force, std::vector<Vector6>& x);

} // namespace grouser::multibody::detail
