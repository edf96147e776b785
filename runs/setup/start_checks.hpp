// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "runs/setup/grain_model.hpp"

namespace grouser::setup {

/// Throws InputError for grains that at the start, or when they enter from a source, overlap each other, a plane, the
/// terrain or a surface by more than run.max_overlap, as far as this is known before the run. Surfaces are at their
/// prescribed position when a grain enters; free surfaces are checked at the start only. `grains`: all of [[grain]] and
/// [[grains]].
void checkStart(const scene::Scene& scene, const GrainKinds& kinds, const std::vector<scene::Grain>& grains,
                const Surroundings& around, double timeStep);

} // namespace grouser::setup
