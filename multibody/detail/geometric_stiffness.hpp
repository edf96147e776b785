// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"
#include "multibody/detail/soft_rows.hpp"

#include <vector>

namespace grouser::multibody::detail {

/// Forces and torques along all rows of each constraint [N, N m]: multipliers, springs, drives and couplings together.
using RowForces = std::vector<Vector6>;

/// Fills the forces in the joints, springs, drives and couplings of one part, linearised at the state's poses
/// (`frames`).
void findRowForces(const ConstraintSystem& system, const Model& model, const ConstraintSystem::Part& part,
                   const std::vector<Frame>& frames, const State& state, const Loads& loads, const SoftRows& softRows,
                   std::vector<Vector6>& x, RowForces& forces);

/// Square of the fastest rate [rad2/s2] at which the geometric stiffness of one part moves its bodies, at the poses of
/// its last linearise(): under tension a chain or spring lets them swing across it, under compression it lets them
/// buckle. `constraint`: the one with the greatest part in it, -1 where there are no forces.
double highestGeometricFrequency(const ConstraintSystem& system, const Model& model, const ConstraintSystem::Part& part,
                                 const std::vector<Pose>& poses, const RowForces& forces, std::vector<Vector6>& x,
                                 int& constraint);

} // namespace grouser::multibody::detail
