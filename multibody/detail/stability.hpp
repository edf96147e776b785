// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"
#include "multibody/state.hpp"

#include <string>
#include <vector>

namespace grouser::multibody::detail {

/// Square of the highest frequency [rad2/s2] of springs of stiffness `stiffness` (one an axis) against the linearised
/// masses of one part, and the axis with the greatest part in it (-1 if there are no springs).
double highestFrequency(const ConstraintSystem& system, const ConstraintSystem::Part& part,
                        const std::vector<double>& stiffness, std::vector<Vector6>& x, int& axis);

/// Stiffness of all axis springs, point springs and bushings, one an axis.
void axisStiffness(const ConstraintSystem& system, const Model& model, const Loads& loads,
                   std::vector<double>& stiffness);

/// Stiffness of the end stops, one an axis.
void stopStiffness(const ConstraintSystem& system, const Model& model, std::vector<double>& stiffness);

/// Damping of joints, springs (the greater of damper and stops) and bushings, one per axis.
void axisDamping(const ConstraintSystem& system, const Model& model, std::vector<double>& damping);

/// "spring 'bar'" or "bushing 'mount'" of the stiffest spring on an axis.
std::string springName(const ConstraintSystem& system, const Model& model, int axis);

} // namespace grouser::multibody::detail
