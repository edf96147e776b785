// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"

#include <utility>
#include <vector>

namespace grouser::multibody::detail {

/// Redundant rows, found at set-up.
struct Redundancy {
  std::vector<std::pair<int, int>> rows; ///< constraint, row: dropped
  std::vector<int> couplings;            ///< implied by others
  int singularAtStart = 0;               ///< rows without pivot only at the starting poses: a singular position
};

/// Finds the hard rows that are implied by others in all positions: moves the mechanism slightly along motions that its
/// constraints allow (the starting velocities, then generic ones), closes the constraints again by Newton's method, and
/// takes the rows without pivot there. A row that is dependent only at the starting poses (a folded four-bar) is kept.
Redundancy findRedundantRows(ConstraintSystem& system, const Model& model);

} // namespace grouser::multibody::detail
