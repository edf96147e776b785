// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/forecast/counted_grains.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/step_limit.hpp"

#include <cstdint>
#include <string>

namespace grouser::commands {

/// What the scene switches on and leaves out, its size, memory and time step. Reads height-map and vehicle spec.
/// `counted`: its grains, where they have been counted; null: about as many as their volume tells.
std::string planText(const scene::Scene& scene, const forecast::CountedGrains* counted = nullptr);

/// What the scene switches on and leaves out, a line each: two spaces, "on" or "off", in columns 7 to 32 what, from 34
/// on why or how. A line without either word tells more of the one before.
std::string switchesText(const scene::Scene& scene);

/// A part of it: particles, markers, sound speed and step limits of the fluid. Empty without one.
std::string fluidText(const scene::Scene& scene, double timeStep);

/// A part of it: every pair of materials that can meet, with the values that act between them, and a note where a value
/// of one material does nothing. Empty where nothing can touch.
std::string pairsText(const scene::Scene& scene);

/// A part of it: shortest contact, time step, number of steps, and the stable steps of a vehicle's own contacts.
/// `step` of the run [s]; `grains`: how many.
std::string timeText(const scene::Scene& scene, const setup::StepLimit& limit, double step, double grains);

/// How `ranks` ranks would share the scene's grains: lattice, ghosts, memory, messages. Empty for a scene without
/// grains.
std::string sharePlan(const scene::Scene& scene, int ranks);

} // namespace grouser::commands
