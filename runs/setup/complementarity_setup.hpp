// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/complementarity_options.hpp"
#include "runs/setup/contact_pairs.hpp"

#include <optional>

namespace grouser::setup {

/// Returns true if run.contact = "complementarity".
bool hasComplementarity(const scene::Scene& scene);

/// Throws InputError for scenes that complementarity contacts do not support: elastic-plastic laws, grains that crush,
/// rigid contacts with cohesion, measured stresses, no grains.
void checkComplementarity(const scene::Scene& scene);

/// Solver options of the scene; empty for penalty contacts.
std::optional<contact::ComplementarityOptions> complementarityOptions(const scene::Scene& scene, double timeStep);

/// Automatic step of a scene with complementarity contacts [s], without the limits from time_scales.hpp: 0.03 of the
/// time in which gravity moves a grain by its diameter, and at most 0.08 diameters at run.impact_speed (a run ends at
/// 0.2).
double complementarityTimeStep(const scene::Scene& scene, const ContactPairs& pairs);

} // namespace grouser::setup
