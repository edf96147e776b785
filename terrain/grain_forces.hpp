// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_system.hpp"

/// Forces on grains from their velocity change in the last step; valid only directly after a step.
namespace grouser::terrain {

/// Mean resultant force / weight [-] of the moving grains in the last step: 1 in free fall, 0 in equilibrium; 0 without
/// gravity. Collective.
double forceRatio(const GrainSystem& system);

/// Resultant contact force on each grain in the last step, by slot [N]: m (v after - v before) / dt - m g. The
/// velocity before the step is known as float without its remainder, so the error is at most m ulp(v) / (2 dt).
/// Undefined for ghosts; 0 for grains that have entered since. Throws std::logic_error unless the last operation was a
/// step.
std::vector<base::Vec3f> contactForces(const GrainSystem& system);

} // namespace grouser::terrain
