// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

namespace grouser::setup {

/// Without attraction, surfaces separate at some speed even with strong dashpots, so a restitution below 1e-6 requires
/// attraction, where 0 means critical damping. Throws InputError at the key, with the step that the minimum requires.
/// Call before any law is made. Complementarity contacts accept 0.
void checkRestitutions(const scene::Scene& scene);

} // namespace grouser::setup
