// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/sweep.hpp"

#include "base/counted.hpp"
#include "runs/campaigns/sweeps/branches.hpp"
#include "runs/campaigns/sweeps/check_cases.hpp"
#include "runs/campaigns/sweeps/run_notices.hpp"
#include "runs/campaigns/sweeps/sweep_files.hpp"
#include "runs/campaigns/sweeps/sweep_intervals.hpp"
#include "runs/campaigns/sweeps/sweep_summary.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/print_stderr.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

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
std::string shortRunsText(const SweepPlan& plan, const SweepFigures& figures,
                          const std::vector<SweepOutcome>& outcomes) {
  int finished = 0, tooShort = 0;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (!output::hasEnded(outcomes[i].status) || !plan.runs[i].scene.vehicle) continue;
    ++finished;
    if (!std::isfinite(figures.from[i])) ++tooShort;
  }
  if (tooShort == 0) return {};
  return fmt::format("note      {} of {} ended before the vehicle reached full speed, so they have no means over the "
                     "steady part; raise run.duration above driver.drive_start + driver.drive_ramp\n",
                     tooShort, base::counted(finished, "run"));
}

/// Warnings and notes in the logs of the runs, except those of inconclusiveText().
std::string noticesOf(const SweepPlan& plan, const fs::path& folder, const SeedIntervals& intervals) {
  bool sinkages = false;
  for (std::size_t c = 0; c < intervals.columns.size(); ++c)
    for (const SeedGroup& group : intervals.groups)
      sinkages = sinkages || (intervals.columns[c].starts_with("sinkage") && std::isfinite(group.figures[c].value));
  std::vector<RunNotice> notices = runNotices(plan, folder, sinkages);
  std::erase_if(notices, [](const RunNotice& n) { return n.text.find("inconclusive") != std::string::npos; });
  return noticesText(notices, plan.runs.size());
}

/// Warning about several seeds if no scene of the plan is random; else empty.
std::string seedsWarning(const SweepPlan& plan) {
  std::set<std::int64_t> seeds;
  for (const SweepRun& run : plan.runs) {
    if (seedMatters(run.scene)) return {};
    seeds.insert(run.scene.run.seed);
  }
  if (seeds.size() < 2) return {};
  return "WARNING: nothing in these scenes is random, so all seeds yield equal results without error bars; remove the "
         "seeds, and run grouser check\n";
}

} // namespace

int runSweep(const SweepPlan& given, const SweepOptions& options) {
  const Claim claim(options);
  if (!options.force) checkSweepFiles(options.folder);
  const SweepPlan plan = options.from ? branched(given, options) : given;
  support::printStderr("{}", seedsWarning(plan));
  const std::vector<SweepOutcome> outcomes = runMissing(
      plan, options, "sweep", [&](const std::vector<SweepOutcome>& now) { writeSummary(plan, now, options.folder); });
  // Files of an earlier sweep with other values.
  for (const char* name : {kIntervalsFile, kSummaryPlot}) fs::remove(options.folder / name);
  std::vector<fs::path> tables = {options.folder / kSummaryFile};
  const SweepFigures figures = sweepFigures(plan, outcomes, options.folder);
  const SeedIntervals intervals = seedIntervals(plan, figures);
  fmt::print("{}{}", noticesOf(plan, options.folder, intervals), inconclusiveText(plan, figures));
  if (!intervals.groups.empty()) {
    fmt::print("{}", intervalsText(intervals));
    tables.push_back(writeIntervals(intervals, options.folder));
    fmt::print("intervals {}\n", tables.back().string());
  }
  fmt::print("summary   {}\n", tables.front().string());
  fmt::print("{}", shortRunsText(plan, figures, outcomes));
  if (options.plot) output::drawPicture("sweep.py", {tables.back()}, options.folder / kSummaryPlot);
  const auto failed = std::count_if(outcomes.begin(), outcomes.end(),
                                    [](const SweepOutcome& o) { return o.status == output::RunStatus::failed; });
  return static_cast<int>(failed);
}

} // namespace grouser::sweeps
