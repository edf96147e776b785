// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "coupling/simulation.hpp"
#include "runs/setup/record_setup.hpp"

#include <filesystem>

namespace grouser::session {

/// Time and size of a run's output.
struct OutputTimes {
  double begin = 0, row = 0, frame = 0, picture = 0, checkpoint = 0; ///< [s] each
  double plot = 0; ///< a plot, including the start of Python [s]; 0 if plots are unavailable
  double frameBytes = 0, checkpointBytes = 0;
};
/// Measures the times to write rows, frames and a checkpoint of the simulation, and to draw a plot if `plots`, in
/// `folder`, which is created and removed. May step the simulation.
OutputTimes timeOutput(coupling::Simulation& simulation, const setup::RecordSetup& record, const base::Exec& exec,
                       const std::filesystem::path& folder, bool plots);

} // namespace grouser::session
