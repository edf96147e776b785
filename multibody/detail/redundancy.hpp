// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"

#include <utility>
#include <vector>

namespace grouser::multibody::detail {

/// Redundant rows, determined at set-up.
struct Redundancy {
  std::vector<std::pair<int, int>> rows; ///< dropped rows: (constraint, row)
  std::vector<int> couplings;            ///< couplings implied by others
  int singularAtStart = 0;               ///< rows without a pivot only at the initial poses, which are singular
};

/// Finds the hard rows implied by others in all positions: moves the mechanism slightly along admissible motions (the
/// initial velocities, then generic velocities), closes the constraints again by Newton's method, and selects the rows
/// without a pivot at these positions. A row that is dependent only at the initial poses (a folded four-bar) is kept.
Redundancy findRedundantRows(ConstraintSystem& system, const Model& model);

} // namespace grouser::multibody::detail
