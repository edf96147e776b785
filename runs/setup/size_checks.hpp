// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

namespace grouser::setup {

/// Throws InputError at the key that makes them, before any memory is taken, when the grains of a [[grains]] cannot fit
/// into the memory that this machine has.
void checkFillSizes(const scene::Scene& scene);
/// The same of a bed.
void checkBedSize(const scene::Scene& scene);

} // namespace grouser::setup
