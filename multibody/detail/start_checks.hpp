// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"

namespace grouser::multibody::detail {

/// Checks of a model before the start. Each throws PartError.

/// Checks that joints and couplings are closed, and that no joint is at the opposite orientation.
void checkClosed(const ConstraintSystem& system, const Model& model);

/// Checks that no two couplings lock their axes. Call it after redundant rows have been dropped.
void checkCouplings(ConstraintSystem& system, const Model& model);

/// Checks that no driven axis is already determined by joints, couplings and earlier drives, and that position laws
/// start at the axis positions. Call it after redundant rows have been dropped.
void checkDrives(ConstraintSystem& system, const Model& model);

/// Checks that the model's velocities satisfy joints and couplings, and, if `drives`, also drives.
void checkVelocities(ConstraintSystem& system, const Model& model, double tolerance, bool drives);

} // namespace grouser::multibody::detail
