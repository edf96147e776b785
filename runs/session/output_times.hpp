// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "coupling/simulation.hpp"
#include "runs/setup/record_setup.hpp"

#include <filesystem>

namespace grouser::session {

/// How long a run takes to write, and how much.
struct OutputTimes {
  double begin = 0, row = 0, frame = 0, picture = 0, checkpoint = 0; ///< [s] each
  double plot = 0; ///< a plot, with the start of Python [s]; 0 where none can be drawn
  double frameBytes = 0, checkpointBytes = 0;
};
/// Writes rows, frames and a checkpoint of the simulation into `folder`, which is made and removed, and where `plots`
/// draws one: how long each of them took. The simulation may be stepped by it.
OutputTimes timeOutput(coupling::Simulation& simulation, const setup::RecordSetup& record, const base::Exec& exec,
                       const std::filesystem::path& folder, bool plots);

} // namespace grouser::session
