// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"
#include "multibody/solver.hpp"

#include <string>
#include <vector>

namespace grouser::multibody::detail {

/// What a model must be before it can start. Each throws base::InputError naming the part.

/// Joints and couplings are closed, and their frames do not stand opposite to one another.
void checkClosed(const ConstraintSystem& system, const Model& model);

/// No two couplings lock the axes that they tie. After the redundant rows are dropped.
void checkCouplings(ConstraintSystem& system, const Model& model);

/// No drive's axis is already determined by joints, couplings and the drives before it; position laws begin where the
/// axes are. After the redundant rows are dropped.
void checkDrives(ConstraintSystem& system, const Model& model);

/// The model's velocities fit joints and couplings, and drives too if `drives`.
void checkVelocities(ConstraintSystem& system, const Model& model, double tolerance, bool drives);

/// Position of each drive's axis at the model's poses.
std::vector<double> driveStart(const ConstraintSystem& system, const Model& model);

/// Laws for linearise() in which nothing but the imposed axes is active, their rates at time t as `speed`.
void imposedLaws(const ConstraintSystem& system, const Model& model, const Loads& loads, double t,
                 std::vector<AxisLaw>& laws);

/// Change of the twists of one part, at a linearised system, that makes them fit the rows: solves
///   M dv - J^T dLambda = 0,   J (v + dv) = rate of the laws (0 on hard rows and couplings).
/// Adds dv to `twist`; the impulses stay in `x`.
void fitTwists(const ConstraintSystem& system, const ConstraintSystem::Part& part, const std::vector<AxisLaw>& laws,
               std::vector<Vector6>& x, std::vector<Twist>& twist);

/// Square of the highest frequency [rad2/s2] of springs of stiffness `stiffness` (one an axis) against the linearised
/// masses of one part, and the axis with the greatest part in it (-1 if there are no springs).
double highestFrequency(const ConstraintSystem& system, const ConstraintSystem::Part& part,
                        const std::vector<double>& stiffness, std::vector<Vector6>& x, int& axis);

/// Stiffness of all axis springs, point springs and bushings, one an axis.
void axisStiffness(const ConstraintSystem& system, const Model& model, const Loads& loads,
                   std::vector<double>& stiffness);

/// Damping of joints, springs (the greater of damper and stops) and bushings, one an axis.
void axisDamping(const ConstraintSystem& system, const Model& model, std::vector<double>& damping);

/// "spring 'bar'" or "bushing 'mount'" of the stiffest spring on an axis.
std::string springName(const ConstraintSystem& system, const Model& model, int axis);

/// Fills axis positions and rates, lengths and bushings' readings from poses and twists; angles within half a turn.
void findAxes(const ConstraintSystem& system, State& state);

/// Rates of the joints' axes at a linearised system.
void readRates(const ConstraintSystem& system, State& state);

} // namespace grouser::multibody::detail
