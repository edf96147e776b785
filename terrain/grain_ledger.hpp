// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_system.hpp"

namespace grouser::terrain {

/// Energies and counts of the grains as they are now; the neighbour list must be valid, ghosts up to date. All ranks
/// call it.
GrainLedger measureLedger(GrainSystem& system);

} // namespace grouser::terrain
