// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check_work.hpp"

#include "base/error.hpp"
#include "runs/campaigns/sweeps/check_series.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/campaigns/sweeps/run_manifest.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/support/hdf5_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace grouser::sweeps {

namespace fs = std::filesystem;
using output::RunStatus;

bool CheckWork::make(const std::vector<int>& seeds, const std::string& what) {
  added_.resize(seeds.size(), 0);
  for (std::size_t c = 0; c < seeds.size(); ++c)
    for (; added_[c] < seeds[c]; ++added_[c]) addRun(c, added_[c]);
  makeAdded(what);
  return std::none_of(record_.outcomes.begin(), record_.outcomes.end(), [](const SweepOutcome& o) {
    return o.status == RunStatus::pending || o.status == RunStatus::stopped;
  });
}

RunCosts CheckWork::pilot(CheckBeds& beds) {
  const int few = record_.cases.seeded ? std::min(options_.maxSeeds(), kFewSeeds) : 1;
  int seed = 0;
  while (seed < few && beds.keptSteps(0, seed)) ++seed;
  const bool settles = seed < few;
  if (!settles) seed = 0;
  addRun(0, seed);
  makeAdded("check, first run");
  const fs::path folder = record_.folder / record_.runs.plan.runs[0].name;
  const RunManifest manifest(folder);
  const double wall = manifest.wallTime();
  if (!output::hasEnded(record_.outcomes[0].status) || !std::isfinite(wall)) throwBaseFailed();
  made_.push_back(record_.runs.plan.runs[0].name);
  record_.runs = {{record_.runs.plan.scene, record_.runs.plan.keys, {}}, {}, {}, {}}, record_.outcomes.clear();

  const auto part = [&](const char* name) {
    return std::max(0.0, std::isfinite(manifest.figure(name)) ? manifest.figure(name) : 0);
  };
  RunCosts costs;
  costs.settling = part("wall_settling_s");
  costs.run = std::max(1e-3, wall - costs.settling - part("wall_cutting_s")); // all runs share the sphere sets
  // A cached bed records the number of its settling steps, but not their wall time.
  if (!settles) costs.settling = 1e-6 * part("microseconds_a_step") * static_cast<double>(*beds.keptSteps(0, 0));
  costs.beds = beds.numbers();
  costs.isKept = [&beds, seed, settles](int bed, int of) {
    const bool justMade = settles && bed == 0 && of == seed; // settled by the first run: includes its cost
    return !justMade && beds.keptSteps(bed, of).has_value();
  };
  return costs;
}

void CheckWork::addRun(std::size_t c, int seedIndex) {
  SweepRun run;
  const std::int64_t seed = firstSeed_ + seedIndex;
  const CheckCase& one = record_.cases.cases[c];
  run.name = record_.cases.seeded ? fmt::format("{},seed={}", one.name, seed) : one.name;
  run.values = {one.name, fmt::format("{}", seed)};
  run.overrides = fixed_;
  for (const std::string& o : one.overrides) putOverride(run.overrides, o);
  putOverride(run.overrides, fmt::format("run.seed={}", seed));
  run.scene = setup::loadScene(record_.runs.plan.scene, run.overrides);
  record_.runs.plan.runs.push_back(std::move(run));
  record_.runs.caseOf.push_back(c), record_.runs.seedOf.push_back(seed);
}

void CheckWork::makeAdded(const std::string& what) {
  SweepOptions sweep = options_.sweep;
  sweep.made = made_;
  // Both limits apply to the whole call, even if the cost of the first run underestimates that of the others.
  const double budget = options_.budget.empty() ? 0 : budgetSeconds(options_.budget);
  for (const double limit : {budget, options_.sweep.seconds}) {
    if (limit <= 0) continue;
    const double left = std::max(1e-9, limit - clock_.seconds());
    sweep.seconds = sweep.seconds > 0 ? std::min(sweep.seconds, left) : left;
  }
  const std::size_t before = record_.outcomes.size();
  SweepPlan plan{record_.runs.plan.scene, record_.runs.plan.keys, {}};
  plan.runs.assign(record_.runs.plan.runs.begin() + static_cast<std::ptrdiff_t>(before), record_.runs.plan.runs.end());
  const std::vector<SweepOutcome> outcomes = runMissing(plan, sweep, what, [](const std::vector<SweepOutcome>&) {});
  record_.outcomes.insert(record_.outcomes.end(), outcomes.begin(), outcomes.end());
  record_.runs.series.resize(record_.outcomes.size());
  for (std::size_t r = before; r < record_.outcomes.size(); ++r)
    if (output::hasEnded(record_.outcomes[r].status)) read(r);
}

/// Reads the series of a run. A run with damaged files counts as failed; repeating the command repeats the run.
void CheckWork::read(std::size_t r) {
  const fs::path folder = record_.folder / record_.runs.plan.runs[r].name;
  try {
    RunSeries series = readSeries(folder);
    if (!hasPartInSeries(record_.cases.cases[record_.runs.caseOf[r]])) series.keepEnd();
    support::Hdf5File::open(folder / "results.h5");
    record_.runs.series[r] = std::move(series);
  } catch (const std::exception& error) {
    record_.outcomes[r] = {
        RunStatus::failed,
        fmt::format("its results are damaged: {}; repeat the command to run it again", error.what())};
    std::error_code none;
    fs::remove(folder / "manifest.json", none);
  }
}

bool CheckWork::hasBase() const {
  for (std::size_t r = 0; r < record_.outcomes.size(); ++r)
    if (record_.runs.caseOf[r] == 0 && output::hasEnded(record_.outcomes[r].status)) return true;
  return false;
}

void CheckWork::throwBaseFailed() const {
  std::string why;
  for (std::size_t r = 0; r < record_.outcomes.size(); ++r)
    if (record_.runs.caseOf[r] == 0) why = record_.outcomes[r].message;
  throw base::SimulationError(fmt::format("no run of the unchanged scene has finished: {}", why));
}

} // namespace grouser::sweeps
