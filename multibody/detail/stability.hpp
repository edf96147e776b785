// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"
#include "multibody/state.hpp"

#include <string>
#include <vector>

namespace grouser::multibody::detail {

/// Squared highest frequency [rad2/s2] of springs with `stiffness` (one value per axis) against the linearised
/// masses of one part, and the axis that contributes most (-1 without springs).
double highestFrequency(const ConstraintSystem& system, const ConstraintSystem::Part& part,
                        const std::vector<double>& stiffness, std::vector<Vector6>& x, int& axis);

/// Computes the stiffness of axis springs, point springs and bushings, one value per axis.
void axisStiffness(const ConstraintSystem& system, const Model& model, const Loads& loads,
                   std::vector<double>& stiffness);

/// Computes the stiffness of the end stops, one value per axis.
void stopStiffness(const ConstraintSystem& system, const Model& model, std::vector<double>& stiffness);

/// Computes the damping of joints, springs (the greater of damper and stops) and bushings, one value per axis.
void axisDamping(const ConstraintSystem& system, const Model& model, std::vector<double>& damping);

/// Name of the stiffest spring on an axis: "spring 'bar'" or "bushing 'mount'".
std::string springName(const ConstraintSystem& system, const Model& model, int axis);

} // namespace grouser::multibody::detail
