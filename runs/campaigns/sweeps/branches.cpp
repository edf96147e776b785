// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/branches.hpp"

#include "base/error.hpp"
#include "runs/campaigns/sweeps/run_manifest.hpp"
#include "runs/output/run_status.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/storage/scene_changes.hpp"
#include "runs/support/build_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace grouser::sweeps {

namespace {

namespace fs = std::filesystem;

constexpr const char* kSettled = "settled"; // folder of the settling run

/// First run of each seed.
std::map<std::int64_t, const SweepRun*> firstOfSeeds(const SweepPlan& plan) {
  std::map<std::int64_t, const SweepRun*> first;
  for (const SweepRun& run : plan.runs) first.emplace(run.scene.run.seed, &run);
  return first;
}

/// Throws if `run` cannot start from the state of `first` before the drive.
void requireOneState(const SweepRun& first, const SweepRun& run) {
  const auto refuse = [&](const std::string& what) {
    throw base::InputError(fmt::format("--from-checkpoint: {}, which changes the common initial state; vary only keys "
                                       "of the driver and hitch, or remove --from-checkpoint",
                                       what));
  };
  const setup::Provenance was = setup::provenanceOf(first.scene), is = setup::provenanceOf(run.scene);
  for (const storage::KeyChange& c : storage::changedKeys(was.resolved, is.resolved))
    if (!storage::actsInTheDrive(c.key))
      refuse(fmt::format("{} is {} in run {} and {} in run {}", c.key, c.was.value_or("not set"), first.name,
                         c.is.value_or("not set"), run.name));
  if (const std::string file = storage::changedFile(was.inputs, is.inputs); !file.empty())
    refuse(fmt::format("file {} differs between the runs {} and {}", file, first.name, run.name));
  const double step = setup::chooseTimeStep(first.scene), other = setup::chooseTimeStep(run.scene);
  if (step != other)
    refuse(fmt::format("run.time_step = \"auto\" is {:g} s in run {} and {:g} s in run {} (set it)", step, first.name,
                       other, run.name));
}

/// Whether the folder contains a settling run by this program from which the run can branch.
bool holdsState(const fs::path& folder, const SweepRun& run) {
  const RunManifest manifest(folder);
  if (manifest.text("status") != "finished" || manifest.text("ended_by") != output::kUntilRest ||
      manifest.commit() != support::buildInfo().commit)
    return false;
  try {
    const fs::path file = folder / storage::kCheckpointName;
    storage::checkSameScene(storage::readOrigin(file), file, setup::provenanceOf(run.scene));
    return true;
  } catch (const base::InputError&) {
    return false; // another scene, or damaged
  }
}

/// Performs the missing settling runs, one per seed. Returns their checkpoints.
std::map<std::int64_t, fs::path> settledStates(const SweepPlan& plan, const SweepOptions& options) {
  const auto seeds = firstOfSeeds(plan);
  SweepPlan base{plan.scene, {}, {}};
  std::map<std::int64_t, fs::path> files;
  for (const auto& [seed, first] : seeds) {
    if (!first->scene.vehicle)
      throw base::InputError(
          "--from-checkpoint: the scene has no vehicle; specify the checkpoint of a run, or remove --from-checkpoint");
    SweepRun run = *first;
    run.name = seeds.size() > 1 ? fmt::format("{},seed={}", kSettled, seed) : kSettled;
    if (std::any_of(plan.runs.begin(), plan.runs.end(), [&](const SweepRun& r) { return r.name == run.name; }))
      throw base::InputError(fmt::format(
          "--case {}: this name is reserved for the settling run of --from-checkpoint; rename the case", kSettled));
    run.untilRest = true, run.expectedEnd = run.scene.driver.driveBegins();
    const fs::path folder = options.folder / run.name;
    files[seed] = folder / storage::kCheckpointName;
    if (!options.force && holdsState(folder, run)) continue;
    std::error_code none;
    if (RunManifest(folder).text("status") == "finished") fs::remove(folder / "manifest.json", none); // run again
    base.runs.push_back(std::move(run));
  }
  if (base.runs.empty()) return files;
  SweepOptions once = options;
  once.seconds = 0;
  const std::vector<SweepOutcome> outcomes =
      runMissing(base, once, "settling", [](const std::vector<SweepOutcome>&) {});
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    if (outcomes[i].status != output::RunStatus::finished)
      throw base::SimulationError(fmt::format("--from-checkpoint: run {} did not come to rest: {}",
                                              (options.folder / base.runs[i].name).string(), outcomes[i].message));
  return files;
}

} // namespace

SweepPlan branched(const SweepPlan& plan, const SweepOptions& options) {
  const auto seeds = firstOfSeeds(plan);
  for (const SweepRun& run : plan.runs) requireOneState(*seeds.at(run.scene.run.seed), run);
  std::map<std::int64_t, fs::path> files;
  if (options.from->empty())
    files = settledStates(plan, options);
  else
    for (const auto& [seed, first] : seeds) files[seed] = *options.from;
  SweepPlan all = plan;
  std::map<std::int64_t, storage::BranchPoint> states;
  for (SweepRun& run : all.runs) {
    const std::int64_t seed = run.scene.run.seed;
    if (const auto at = states.find(seed); at == states.end()) {
      const storage::Checkpoint state = storage::readCheckpoint(files[seed]);
      storage::checkSameScene(state, files[seed], setup::provenanceOf(run.scene), "--from-checkpoint");
      states[seed] = storage::branchPoint(files[seed], state);
    }
    run.from = states[seed];
  }
  return all;
}

} // namespace grouser::sweeps
