// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/grain_kinds.hpp"

namespace grouser::setup {

/// The scene must fit into what grains are made of: integer positions, whose range and resolution follow from the
/// largest grain, and lists of at most 32 boundaries. Throws InputError with the place of what does not; the grains
/// themselves check the same, but know of no file.
void checkGrainSpace(const scene::Scene& scene, const GrainKinds& kinds);

} // namespace grouser::setup
