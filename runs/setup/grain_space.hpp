// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/grain_kinds.hpp"

namespace grouser::setup {

/// Checks that the scene fits the limits of grains: integer positions, with range and resolution from the largest
/// grain, and at most 32 boundaries. Throws InputError with the place in the file; terrain::Grains checks the same
/// without the place.
void checkGrainSpace(const scene::Scene& scene, const GrainKinds& kinds);

/// Throws InputError if periodic boundaries are too close for the gaps that complementarity contacts include at this
/// step [s].
void checkPeriodicSides(const scene::Scene& scene, const GrainKinds& kinds, double timeStep);

} // namespace grouser::setup
