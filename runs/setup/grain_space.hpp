// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/grain_kinds.hpp"

namespace grouser::setup {

/// Checks that the scene fits the limits of grains: integer positions, with range and resolution from the largest
/// grain, and at most 32 boundaries. Throws InputError with the place in the file; terrain::Grains checks the same
/// without the place.
void checkGrainSpace(const scene::Scene& scene, const GrainKinds& kinds);

} // namespace grouser::setup
