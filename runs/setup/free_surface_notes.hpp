// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// Notes on light free surfaces and bodies, with the actual restitution and the required mass: since damping depends
/// only on the grain mass, grains rebound from them with less than the given restitution.
std::vector<std::string> freeSurfaceNotes(const scene::Scene& scene);

/// Lists the objects that bodies with shapes pass through; empty if there are none.
std::string bodyContactsNote(const scene::Scene& scene);

} // namespace grouser::setup
