// SPDX-License-Identifier: BSD-3-Clause
#include "runs/sweeps/sweep.hpp"

#include "runs/output/plots.hpp"
#include "runs/sweeps/sweep_files.hpp"
#include "runs/sweeps/sweep_intervals.hpp"
#include "runs/sweeps/sweep_summary.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::sweeps {

namespace fs = std::filesystem;

int runSweep(const SweepPlan& plan, const SweepOptions& options) {
  if (!options.force) checkSweepFiles(options.folder);
  const std::vector<SweepOutcome> outcomes = runMissing(
      plan, options, "sweep", [&](const std::vector<SweepOutcome>& now) { writeSummary(plan, now, options.folder); });
  std::vector<fs::path> tables = {options.folder / kSummaryFile};
  const SeedIntervals intervals = seedIntervals(plan, sweepFigures(plan, outcomes, options.folder));
  if (!intervals.groups.empty()) {
    fmt::print("{}", intervalsText(intervals));
    tables.push_back(writeIntervals(intervals, options.folder));
    fmt::print("intervals {}\n", tables.back().string());
  }
  fmt::print("summary   {}\n", tables.front().string());
  if (options.plot) output::drawPicture("sweep.py", {tables.back()}, options.folder / kSummaryPlot);
  const auto failed = std::count_if(outcomes.begin(), outcomes.end(),
                                    [](const SweepOutcome& o) { return o.status == output::RunStatus::failed; });
  return static_cast<int>(failed);
}

} // namespace grouser::sweeps
