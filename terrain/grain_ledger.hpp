// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_system.hpp"

namespace grouser::terrain {

/// Measures current energies and counts of the grains; requires a valid neighbour list and up-to-date ghosts.
/// Collective.
GrainLedger measureLedger(GrainSystem& system);

} // namespace grouser::terrain
