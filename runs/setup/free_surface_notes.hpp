// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// Notes on free surfaces and bodies so light that grains rebound from them with less than the given restitution, since
/// damping depends on the grain's mass only: the actual restitution, and the required mass.
std::vector<std::string> freeSurfaceNotes(const scene::Scene& scene);

/// Lists what bodies with shapes pass through; empty where there is nothing else.
std::string bodyContactsNote(const scene::Scene& scene);

} // namespace grouser::setup
