// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/impulse_law.hpp"
#include "runs/setup/contact_pairs.hpp"

#include <optional>

namespace grouser::setup {

/// Whether the scene's grains have complementarity contacts.
bool hasComplementarity(const scene::Scene& scene);

/// Throws InputError at what these contacts do not have: vehicles, bodies, meshes, laws that yield, measured stresses;
/// and where the scene has no grains.
void checkComplementarity(const scene::Scene& scene);

/// How the steps of such a scene are solved; empty for penalty contacts.
std::optional<contact::ComplementarityOptions> complementarityOptions(const scene::Scene& scene, double timeStep);

/// The automatic step of such a scene [s], before what moves over time is resolved: 0.03 of the time in which gravity
/// moves a grain by its diameter, and at most 0.08 of the diameter at run.impact_speed: a run ends at 0.2.
double complementarityTimeStep(const scene::Scene& scene, const ContactPairs& pairs);

} // namespace grouser::setup
