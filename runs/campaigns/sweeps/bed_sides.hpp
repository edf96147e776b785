// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>

namespace grouser::sweeps {

/// The first plane, box, cylinder or mesh of a scene with a bed that stands at one of the bed's sides along y, or where
/// the bed would go on there if it were so many times as wide: "plane 1 (left wall)", its number in the file from 0.
/// Empty where there is none. What is put above the bed once it has settled is none, nor is a plane that is the same
/// all along y.
std::string surfaceAtSides(const scene::Scene& scene, double timesAsWide);

} // namespace grouser::sweeps
