// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check_record.hpp"

#include "base/counted.hpp"
#include "base/math.hpp"
#include "runs/campaigns/sweeps/run_manifest.hpp"
#include "runs/jobs/study_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::sweeps {

namespace {

using output::RunStatus;

/// Median of the finite values; NaN if there are none.
double medianOf(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  return values.empty() ? base::kNaN : jobs::medianOf(std::move(values));
}

} // namespace

std::vector<CaseCost> costsOf(const CheckRecord& record) {
  struct Taken {
    std::vector<double> wall, cpu, steps;
  };
  std::vector<Taken> taken(record.cases.cases.size());
  for (std::size_t r = 0; r < record.runs.caseOf.size(); ++r) {
    if (!output::hasEnded(record.outcomes[r].status)) continue;
    const RunManifest manifest(record.folder / record.runs.plan.runs[r].name);
    Taken& of = taken[record.runs.caseOf[r]];
    of.wall.push_back(manifest.wallTime());
    of.cpu.push_back(manifest.stepsOverTimed() * manifest.figure("cpu_steps_s"));
    of.steps.push_back(manifest.number("steps"));
  }
  std::vector<CaseCost> costs;
  for (const Taken& of : taken) costs.push_back({medianOf(of.wall), medianOf(of.cpu), medianOf(of.steps)});
  return costs;
}

CaseStatus statusOf(const CheckRecord& record, std::size_t aCase) {
  if (!record.cases.cases[aCase].refused.empty()) return {"refused", record.cases.cases[aCase].refused};
  if (std::find(record.beyondBudget.begin(), record.beyondBudget.end(), aCase) != record.beyondBudget.end())
    return {"left out", "beyond the budget"};
  const bool has = std::find(record.runs.caseOf.begin(), record.runs.caseOf.end(), aCase) != record.runs.caseOf.end();
  if (!has && !record.looks.seeds.empty()) return {"left out", "not required for the error bars of --of", false};
  std::size_t runs = 0, ended = 0, failed = 0;
  std::string failure;
  for (std::size_t r = 0; r < record.runs.caseOf.size(); ++r) {
    if (record.runs.caseOf[r] != aCase) continue;
    const SweepOutcome& outcome = record.outcomes[r];
    if (outcome.status == RunStatus::incomplete) return {"incomplete", outcome.message};
    ++runs;
    if (output::hasEnded(outcome.status)) ++ended;
    if (outcome.status != RunStatus::failed) continue;
    if (++failed == 1) failure = outcome.message;
  }
  if (failed > 0 && ended > 0)
    return {"partly failed", fmt::format("{} of {} failed: {}", failed, base::counted(runs, "run"), failure)};
  if (failed > 0) return {"failed", failure};
  return {ended > 0 ? "finished" : "not begun", ""};
}

} // namespace grouser::sweeps
