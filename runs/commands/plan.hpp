// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/forecast/counted_grains.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/step_limit.hpp"

#include <cstdint>
#include <string>

namespace grouser::commands {

/// Active features, size, memory and time step of a scene. Reads height-map and vehicle file. `counted`: number of
/// grains; null: estimate the number from the volume.
std::string planText(const scene::Scene& scene, const forecast::CountedGrains* counted = nullptr);

/// Active and inactive features, one per line: two spaces, "on" or "off", the feature in columns 7 to 32, the reason
/// from column 34. A line without "on" or "off" continues the previous line.
std::string switchesText(const scene::Scene& scene);

/// Section of planText(): particles, markers, sound speed and step limits of the fluid. Empty without a fluid.
std::string fluidText(const scene::Scene& scene, double timeStep);

/// Section of planText(): contact parameters by material pair, with a note on each value that has no effect. Empty if
/// the scene has no contacts.
std::string pairsText(const scene::Scene& scene);

/// Section of planText(): shortest contact, time step, number of steps, and stable steps of a vehicle's own contacts.
/// `step`: time step of the run [s]; `grains`: number of grains.
std::string timeText(const scene::Scene& scene, const setup::StepLimit& limit, double step, double grains);

/// Distribution of the scene's grains over `ranks` ranks: lattice, ghosts, memory, messages. Empty for a scene without
/// grains.
std::string sharePlan(const scene::Scene& scene, int ranks);

} // namespace grouser::commands
