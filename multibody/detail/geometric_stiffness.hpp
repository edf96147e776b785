// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"
#include "multibody/detail/soft_rows.hpp"

#include <vector>

namespace grouser::multibody::detail {

/// Forces and torques along all rows of each constraint [N, N m]: sum of multipliers, springs, drives and couplings.
using RowForces = std::vector<Vector6>;

/// Computes the forces of joints, springs, drives and couplings of one part, linearised at the state's poses
/// (`frames`).
void findRowForces(const ConstraintSystem& system, const Model& model, const ConstraintSystem::Part& part,
                   const std::vector<Frame>& frames, const State& state, const Loads& loads, const SoftRows& softRows,
                   std::vector<Vector6>& x, RowForces& forces);

/// Largest squared rate [rad2/s2] of the motion due to the geometric stiffness of one part, at the poses of the last
/// linearise(): transverse oscillation of a chain or spring under tension, buckling under compression. `constraint`:
/// the constraint that contributes most; -1 without forces.
double highestGeometricFrequency(const ConstraintSystem& system, const Model& model, const ConstraintSystem::Part& part,
                                 const std::vector<Pose>& poses, const RowForces& forces, std::vector<Vector6>& x,
                                 int& constraint);

} // namespace grouser::multibody::detail
