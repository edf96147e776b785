// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_system.hpp"

/// Forces on grains, from the change of their velocities in the last step: only right after a step.
namespace grouser::terrain {

/// See Grains::forceRatio(). All ranks call it.
double forceRatio(const GrainSystem& system);

} // namespace grouser::terrain
