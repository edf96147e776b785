// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/sources.hpp"

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

struct GrainKinds;

/// Sources of a scene, with their times in steps.
coupling::Sources sourcesOf(const scene::Scene& scene, const GrainKinds& kinds, double timeStep);

/// Throws base::InputError at a source with grains that do not fit into its box without overlap.
void checkSources(const scene::Scene& scene, const GrainKinds& kinds);

} // namespace grouser::setup
