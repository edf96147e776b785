// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/sweep_plan.hpp"
#include "runs/campaigns/sweeps/sweep_summary.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Runs of a scene as processes of their own.
namespace grouser::sweeps {

struct SweepOptions {
  std::filesystem::path program; ///< of grouser
  std::filesystem::path folder;  ///< the runs' folders go in here, with summary.csv and summary.png
  int jobs = 1;                  ///< runs at the same time
  double seconds = 0;            ///< no run is begun after so many; 0: no end
  bool force = false;            ///< run again what has already been run, and overwrite folders of other origin
  std::vector<std::string> made; ///< names of runs that `force` does not run again: made a moment ago
  bool plot = true;
  std::optional<std::filesystem::path> from; ///< checkpoint that all runs branch from; empty path: made for them
  bool failuresStay = false;                 ///< a run that has failed is a result: it is not run again
  bool shared = false;                       ///< other calls work in the same folder at the same time, on other runs
};

using OutcomesChanged = std::function<void(const std::vector<SweepOutcome>&)>;

/// What decides the result of a run, as text: the resolved scene without device, threads and folder.
std::string identity(scene::Scene scene);

/// "2 of 3 runs finished"; "2 of 2 runs ended, 1 incomplete".
std::string endedText(const std::vector<SweepOutcome>& outcomes);

/// Runs what is not there yet, at most `jobs` at a time: in the order of the plan, but where several may go at a time
/// and `seconds` sets no end, those with the most work first, since the longest would else be what all wait for
/// (workOf). A run is left out when its folder holds a finished one of the same identity(), the same bytes of all files
/// that the scene names, and the same commit of the program, that has branched from the same state; what is half done
/// goes on from its checkpoint, if it has one, and what is of another scene is run again. `changed` is called at the
/// start and after every run; `what` stands before the lines of progress. Throws InputError, before anything is
/// started, where a run's folder holds something else. Returns how each run stands.
std::vector<SweepOutcome> runMissing(const SweepPlan& plan, const SweepOptions& options, const std::string& what,
                                     const OutcomesChanged& changed);

} // namespace grouser::sweeps
