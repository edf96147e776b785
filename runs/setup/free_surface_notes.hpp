// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// Free surfaces and bodies so light that grains rebound from them with less than the restitution that the scene asks
/// for: damping follows from the grain's mass alone. How much less, and the mass that remedies it.
std::vector<std::string> freeSurfaceNotes(const scene::Scene& scene);

/// Lists what bodies with shapes pass through; empty where there is nothing else.
std::string bodyContactsNote(const scene::Scene& scene);

} // namespace grouser::setup
