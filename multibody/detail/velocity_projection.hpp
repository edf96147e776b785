// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"
#include "multibody/state.hpp"

#include <vector>

namespace grouser::multibody::detail {

/// Returns laws for linearise() in which only imposed axes are active, with their rates at time t as `speed`.
void imposedLaws(const ConstraintSystem& system, const Model& model, const Loads& loads, double t,
                 std::vector<AxisLaw>& laws);

/// Projects the twists of one part onto the linearised constraints: solves
///   M dv - J^T dLambda = 0,   J (v + dv) = prescribed rate (0 for hard constraints and couplings).
/// Adds dv to `twist`; returns the impulses in `x`.
void projectTwists(const ConstraintSystem& system, const ConstraintSystem::Part& part, const std::vector<AxisLaw>& laws,
                   std::vector<Vector6>& x, std::vector<Twist>& twist);

/// Computes the rates of the joint axes at a linearised system.
void readRates(const ConstraintSystem& system, State& state);

} // namespace grouser::multibody::detail
