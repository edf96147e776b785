// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/sources.hpp"
#include "terrain/grains.hpp"

#include <string>
#include <vector>

namespace grouser::coupling {

/// Makes `grains` reject entering grains that would overlap grains or surfaces: InputError before the first step,
/// SimulationError later, both with the name of the source. `surfaces`: names of the grains' surfaces.
void guardInsertion(terrain::Grains& grains, const Sources& sources, const std::vector<std::string>& surfaces);

} // namespace grouser::coupling
