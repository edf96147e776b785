// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/forecast/probe.hpp"

#include <filesystem>

namespace grouser::commands {

/// Writes rows, frames and a checkpoint of the simulation into `folder`, which is made and removed, and where `plots`
/// draws one: how long each of them took. A forecast::OutputTimer.
forecast::OutputTimes timeOutput(simulation::Simulation& simulation, const base::Exec& exec,
                                 const std::filesystem::path& folder, bool plots);

} // namespace grouser::commands
