// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

namespace grouser::setup {

/// Dashpots that do not pull let surfaces separate at some speed, however strong they are: a restitution below 1e-6
/// requires attraction, with which 0 is critical damping. Throws InputError at the key, with the step that the minimum
/// requires. Call before any law is made. Complementarity contacts accept 0.
void checkRestitutions(const scene::Scene& scene);

} // namespace grouser::setup
