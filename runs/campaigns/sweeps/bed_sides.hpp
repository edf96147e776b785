// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>

namespace grouser::sweeps {

/// First plane, box, cylinder or mesh at a side of the bed along y, or within a bed that is `timesAsWide` as wide:
/// "plane 1 (left wall)", counted from 0 in the file. Empty if there is no such surface. Excludes surfaces placed
/// above the settled bed and planes that do not depend on y.
std::string surfaceAtSides(const scene::Scene& scene, double timesAsWide);

} // namespace grouser::sweeps
