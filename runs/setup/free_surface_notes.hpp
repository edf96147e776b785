// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// Notes on light free surfaces and bodies, with the actual restitution and the required mass: since damping depends
/// only on the grain mass, grains rebound from them with less than the given restitution.
std::vector<std::string> freeSurfaceNotes(const scene::Scene& scene);

/// Warning about moving surfaces, which bodies with shapes pass through; empty if there are none.
std::string movingSurfacesWarning(const scene::Scene& scene);
/// Note on the walls and the floor of a bed, which bodies with shapes pass through; empty without such bodies or a bed.
std::string bedWallsNote(const scene::Scene& scene);

} // namespace grouser::setup
