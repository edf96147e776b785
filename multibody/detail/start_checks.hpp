// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"

namespace grouser::multibody::detail {

/// Checks of a model before the start. Each throws PartError.

/// Joints and couplings are closed, and their frames do not stand opposite to one another.
void checkClosed(const ConstraintSystem& system, const Model& model);

/// No two couplings lock their axes. Call after dropping redundant rows.
void checkCouplings(ConstraintSystem& system, const Model& model);

/// No drive's axis is already determined by joints, couplings and the drives before it; position laws start at the axis
/// positions. Call after dropping redundant rows.
void checkDrives(ConstraintSystem& system, const Model& model);

/// The model's velocities satisfy joints and couplings, and drives too if `drives`.
void checkVelocities(ConstraintSystem& system, const Model& model, double tolerance, bool drives);

} // namespace grouser::multibody::detail
