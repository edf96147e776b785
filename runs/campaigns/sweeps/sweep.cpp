// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/sweep.hpp"

#include "base/counted.hpp"
#include "runs/campaigns/sweeps/branches.hpp"
#include "runs/campaigns/sweeps/sweep_files.hpp"
#include "runs/campaigns/sweeps/sweep_intervals.hpp"
#include "runs/campaigns/sweeps/sweep_summary.hpp"
#include "runs/output/plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::sweeps {

namespace fs = std::filesystem;

namespace {

/// Warnings for runs with inconclusive figures, and for finished runs without a steady part.
std::string inconclusiveText(const SweepPlan& plan, const SweepFigures& figures) {
  std::string first;
  std::size_t count = 0;
  for (std::size_t i = 0; i < plan.runs.size(); ++i)
    if (const std::string doubt = figures.doubtOf(i); !doubt.empty() && ++count == 1)
      first = fmt::format("{}: {}", plan.runs[i].name, doubt);
  if (count == 0) return {};
  return fmt::format("WARNING: {} of {} runs {} inconclusive ({})\n", count, plan.runs.size(),
                     count == 1 ? "is" : "are", first);
}
std::string shortRunsText(const SweepFigures& figures, const std::vector<SweepOutcome>& outcomes) {
  const auto column = std::find(figures.columns.begin(), figures.columns.end(), "steady from [s]");
  if (column == figures.columns.end()) return {};
  const auto at = static_cast<std::size_t>(column - figures.columns.begin());
  int finished = 0, tooShort = 0;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (!output::hasEnded(outcomes[i].status)) continue;
    ++finished;
    if (!std::isfinite(figures.values[i][at])) ++tooShort;
  }
  if (tooShort == 0) return {};
  return fmt::format("note      {} of {} ended before the vehicle reached full speed, so they have no means over the "
                     "steady part; raise run.duration above driver.drive_start + driver.drive_ramp\n",
                     tooShort, base::counted(finished, "run"));
}

} // namespace

int runSweep(const SweepPlan& given, const SweepOptions& options) {
  if (!options.force) checkSweepFiles(options.folder);
  const SweepPlan plan = options.from ? branched(given, options) : given;
  const std::vector<SweepOutcome> outcomes = runMissing(
      plan, options, "sweep", [&](const std::vector<SweepOutcome>& now) { writeSummary(plan, now, options.folder); });
  // Files of an earlier sweep with other values.
  for (const char* name : {kIntervalsFile, kSummaryPlot}) fs::remove(options.folder / name);
  std::vector<fs::path> tables = {options.folder / kSummaryFile};
  const SweepFigures figures = sweepFigures(plan, outcomes, options.folder);
  fmt::print("{}", inconclusiveText(plan, figures));
  const SeedIntervals intervals = seedIntervals(plan, figures);
  if (!intervals.groups.empty()) {
    fmt::print("{}", intervalsText(intervals));
    tables.push_back(writeIntervals(intervals, options.folder));
    fmt::print("intervals {}\n", tables.back().string());
  }
  fmt::print("summary   {}\n", tables.front().string());
  fmt::print("{}", shortRunsText(figures, outcomes));
  if (options.plot) output::drawPicture("sweep.py", {tables.back()}, options.folder / kSummaryPlot);
  const auto failed = std::count_if(outcomes.begin(), outcomes.end(),
                                    [](const SweepOutcome& o) { return o.status == output::RunStatus::failed; });
  return static_cast<int>(failed);
}

} // namespace grouser::sweeps
