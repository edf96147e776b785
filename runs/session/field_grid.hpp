// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/record_setup.hpp"
#include "terrain/grains.hpp"

#include <filesystem>
#include <optional>

namespace grouser::session {

/// The cells of the soil's fields; none where the scene wants none. Their box is that of the scene, else that of the
/// frames in `former`, a folder that the run goes on with, else the one around all grains now, to periodic boundaries,
/// and one cell higher for what is heaped up. All ranks call it. Throws InputError where it has too many cells.
std::optional<terrain::FieldGrid> fieldGridOf(const setup::OutputSetup& output, const terrain::Grains& grains,
                                              const terrain::PeriodicBoundaries& periodic,
                                              const std::optional<std::filesystem::path>& former);

} // namespace grouser::session
