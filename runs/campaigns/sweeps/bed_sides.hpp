// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>

namespace grouser::sweeps {

/// First plane, box, cylinder or mesh at a side of the bed along y, or in the space of a bed `timesAsWide` as wide:
/// "plane 1 (left wall)", numbered from 0 in the file. Empty if none. Excludes surfaces placed above the settled bed
/// and planes that are uniform along y.
std::string surfaceAtSides(const scene::Scene& scene, double timesAsWide);

} // namespace grouser::sweeps
