// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation_setup.hpp"
#include "runs/setup/ground_setup.hpp"

namespace grouser::setup {

/// Compiles a scene for a simulation on `ranks` ranks. `sizes`: passed if the scene has passed checkFillSizes() and
/// checkBedSize(). Throws InputError with the place of the error.
coupling::SimulationSetup simulationSetup(const scene::Scene& scene, int ranks = 1, SizeChecks sizes = SizeChecks::due);

} // namespace grouser::setup
