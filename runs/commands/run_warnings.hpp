// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"

namespace grouser::commands {

/// Prints to the standard error what is sound and may still surprise.
void warnOf(const scene::Scene& scene, const coupling::Simulation& simulation);

} // namespace grouser::commands
