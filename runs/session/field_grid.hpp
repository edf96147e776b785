// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/record_setup.hpp"
#include "terrain/grains.hpp"

#include <filesystem>
#include <optional>

namespace grouser::session {

/// Grid of the soil fields; empty if the scene has none. Its box is that of the scene, else that of the frames in
/// `former`, the folder of a resumed run, else the box around all grains, to periodic boundaries, one cell higher for
/// heaps. All ranks call it. Throws InputError for too many cells.
std::optional<terrain::FieldGrid> fieldGridOf(const setup::OutputSetup& output, const terrain::Grains& grains,
                                              const terrain::PeriodicBoundaries& periodic,
                                              const std::optional<std::filesystem::path>& former);

} // namespace grouser::session
