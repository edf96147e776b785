// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "runs/setup/grain_model.hpp"

namespace grouser::setup {

/// Throws InputError for grains that start, or that sources will set, deeper in each other, in a plane, in the terrain
/// or in a surface than run.max_overlap allows: whatever of it can be known before the run. Surfaces are taken where
/// their motion has them when a grain enters; those that forces move, at the start alone. `grains`: all of [[grain]]
/// and [[grains]].
void checkStart(const scene::Scene& scene, const GrainKinds& kinds, const std::vector<scene::Grain>& grains,
                const Surroundings& around, double timeStep);

} // namespace grouser::setup
