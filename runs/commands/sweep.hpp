// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/commands/sweep_plan.hpp"

#include <filesystem>

/// Many runs of one scene, over the product of all given values.
///
/// Each run is a process of its own, so that one that fails, or crashes, takes no other with it, and that all memory
/// comes back between two runs.
namespace grouser::commands {

struct SweepOptions {
  std::filesystem::path program; ///< of grouser
  std::filesystem::path folder;  ///< the runs' folders go in here, with summary.csv and summary.png
  int jobs = 1;                  ///< runs at the same time
  double seconds = 0;            ///< no run is begun after so many; 0: no end
  bool force = false;            ///< run again what has already been run, and overwrite folders of other origin
  bool plot = true;
};

/// Runs what is not there yet. A run is left out when its folder holds a finished one of the same resolved scene
/// (device, threads and the output folder aside, on which no result depends); what is half done or of another scene is
/// run again. summary.csv is written anew after every run; where seeds are swept, intervals.csv at the end. Returns the
/// number of failed runs. Throws InputError, before
/// anything is started, where a run's folder holds something else.
int runSweep(const SweepPlan& plan, const SweepOptions& options);

} // namespace grouser::commands
