// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/record_setup.hpp"
#include "terrain/grains.hpp"

#include <filesystem>
#include <optional>

namespace grouser::session {

/// Grid of the soil fields; empty if the scene has none. The box of the grid is given in the scene, or in the frames of
/// a resumed run (folder `former`), or it contains all grains, extends to periodic boundaries, and is one cell higher
/// for heaps. All ranks call it. Throws InputError for too many cells.
std::optional<terrain::FieldGrid> fieldGridOf(const setup::OutputSetup& output, const terrain::Grains& grains,
                                              const terrain::PeriodicBoundaries& periodic,
                                              const std::optional<std::filesystem::path>& former);

} // namespace grouser::session
