// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"

namespace grouser::multibody::detail {

/// What a model must be before it can start. Each throws PartError.

/// Joints and couplings are closed, and their frames do not stand opposite to one another.
void checkClosed(const ConstraintSystem& system, const Model& model);

/// No two couplings lock the axes that they tie. After the redundant rows are dropped.
void checkCouplings(ConstraintSystem& system, const Model& model);

/// No drive's axis is already determined by joints, couplings and the drives before it; position laws begin where the
/// axes are. After the redundant rows are dropped.
void checkDrives(ConstraintSystem& system, const Model& model);

/// The model's velocities fit joints and couplings, and drives too if `drives`.
void checkVelocities(ConstraintSystem& system, const Model& model, double tolerance, bool drives);

} // namespace grouser::multibody::detail
