// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_system.hpp"

/// Forces on grains, from the change of their velocities in the last step: valid only directly after a step.
namespace grouser::terrain {

/// Mean over the moving grains of the resultant force on a grain over its weight [-], in the last step: 1 in free fall,
/// 0 in balance; 0 without gravity. All ranks call it.
double forceRatio(const GrainSystem& system);

/// Resultant of all contact forces on each grain in the last step, by slot [N]: m (v after - v before) / dt - m g. Of
/// the velocity before only the float is known, not its remainder, so the error is at most m ulp(v) / (2 dt). That of a
/// ghost is undefined; of a grain that has entered since it is 0. Throws std::logic_error where something else than a
/// step came last.
std::vector<base::Vec3f> contactForces(const GrainSystem& system);

} // namespace grouser::terrain
