// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

namespace grouser::setup {

/// Throws InputError at the key, before any memory is allocated, if the grains of a [[grains]] do not fit into the
/// memory of this machine.
void checkFillSizes(const scene::Scene& scene);
/// The same for a bed.
void checkBedSize(const scene::Scene& scene);

} // namespace grouser::setup
