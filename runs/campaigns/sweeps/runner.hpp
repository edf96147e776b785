// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/sweep_plan.hpp"
#include "runs/campaigns/sweeps/sweep_summary.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Runs of scenes, one process each.
namespace grouser::sweeps {

inline constexpr const char* kRunLog = "log.txt"; ///< output of a run, in its folder

struct SweepOptions {
  std::filesystem::path program; ///< grouser executable
  std::filesystem::path folder;  ///< contains the folders of the runs, summary.csv and summary.png
  int jobs = 1;                  ///< runs at the same time
  double seconds = 0;            ///< no run starts after this wall time; 0: no limit
  bool force = false;            ///< repeat finished runs, and overwrite other folders
  std::vector<std::string> made; ///< names of runs that `force` does not repeat: performed by this call
  bool plot = true;
  std::optional<std::filesystem::path> from; ///< checkpoint that all runs branch from; empty path: from settling runs
  bool keepFailures = false;                 ///< failed runs are results and not repeated
  bool shared = false;                       ///< other calls perform other runs in the same folder
};

using OutcomesChanged = std::function<void(const std::vector<SweepOutcome>&)>;

/// Text that determines the result of a run: the resolved scene without device, threads and folder.
std::string identity(scene::Scene scene);

/// "2 of 3 runs finished"; "2 of 2 runs ended, 1 incomplete".
std::string endedText(const std::vector<SweepOutcome>& outcomes);

/// Performs missing runs, at most `jobs` at a time: in the order of the plan, but with several jobs and no time limit
/// the longest first (workOf). A run is skipped if its folder contains a finished one with the same identity(), input
/// files, program commit and branch state; unfinished runs resume from their checkpoints, and runs of other scenes are
/// repeated. `changed` is called at the start and after every run; `what`: label of the progress lines. Throws
/// InputError before any run starts if a folder contains something else. Returns the outcomes of all runs.
std::vector<SweepOutcome> runMissing(const SweepPlan& plan, const SweepOptions& options, const std::string& what,
                                     const OutcomesChanged& changed);

} // namespace grouser::sweeps
