// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

namespace grouser::setup {

/// Dashpots that do not pull let surfaces part with some speed, however strong they are: a restitution below 1e-6 takes
/// attraction, with which 0 is critical damping. Throws InputError at the key that asks for less without, with the step
/// that the least would take. Before any law is made. Complementarity contacts accept 0.
void checkRestitutions(const scene::Scene& scene);

} // namespace grouser::setup
