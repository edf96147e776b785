// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/sweep_plan.hpp"
#include "runs/campaigns/sweeps/sweep_summary.hpp"
#include "runs/support/folder_use.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Runs scenes, each in a separate process.
namespace grouser::sweeps {

struct SweepOptions {
  std::filesystem::path program; ///< grouser executable
  std::filesystem::path folder;  ///< contains the folders of the runs, summary.csv and summary.png
  int jobs = 1;                  ///< number of concurrent runs
  double seconds = 0;            ///< start no new runs after this wall time [s]; 0: no limit
  bool force = false;            ///< repeat finished runs, and overwrite folders of other results
  std::vector<std::string> made; ///< names of runs performed by this call, which `force` does not repeat
  bool plot = true;
  std::optional<std::filesystem::path> from; ///< checkpoint from which all runs branch; empty path: settling runs
  bool keepFailures = false;                 ///< failed runs are results and are not repeated
  bool shared = false;                       ///< whether other calls perform other runs in the same folder
  /// Lock on the folder, and the number of claims that hold it.
  struct Use {
    support::FileLock lock;
    int claims = 0;
  };
  std::shared_ptr<Use> use = std::make_shared<Use>(); ///< see Claim
};

/// Holds the lock on the folder of these options, if it exists and is not shared, until the last claim of the same
/// options is destroyed. The constructor throws InputError if another command uses the folder.
class Claim {
public:
  explicit Claim(const SweepOptions& options);
  ~Claim();
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

private:
  std::shared_ptr<SweepOptions::Use> use_;
};

using OutcomesChanged = std::function<void(const std::vector<SweepOutcome>&)>;

/// Text that determines the results of a run: the resolved scene without device, threads and folder.
std::string identity(scene::Scene scene);

/// "2 of 3 runs finished"; "2 of 2 runs ended, 1 incomplete".
std::string endedText(const std::vector<SweepOutcome>& outcomes);

/// Performs missing runs, at most `jobs` at a time, in the order of the plan; with several jobs and no time limit, the
/// longest run (workOf) first. Skips a run if its folder contains a finished run with the same identity(), input files,
/// program commit and branch state. Resumes unfinished runs from their checkpoints, and repeats runs of other scenes.
/// `changed` is called at the start and after each run; `what`: label of the progress lines. Throws InputError before
/// any run starts if a folder contains other files. Returns the outcomes of all runs.
std::vector<SweepOutcome> runMissing(const SweepPlan& plan, const SweepOptions& options, const std::string& what,
                                     const OutcomesChanged& changed);

} // namespace grouser::sweeps
