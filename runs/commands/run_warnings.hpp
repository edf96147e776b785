// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "runs/simulation/simulation.hpp"

namespace grouser::commands {

/// Prints to the standard error what is sound and may still surprise.
void warnOf(const scene::Scene& scene, const simulation::Simulation& simulation);

} // namespace grouser::commands
