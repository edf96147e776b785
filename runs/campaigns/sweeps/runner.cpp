// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/runner.hpp"

#include "base/counted.hpp"
#include "base/error.hpp"
#include "base/exec.hpp"
#include "base/math.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/campaigns/sweeps/run_manifest.hpp"
#include "runs/campaigns/sweeps/run_progress.hpp"
#include "runs/campaigns/sweeps/sweep_files.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/storage/checkpoint.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/child_process.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/gpu_sharing.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <list>
#include <optional>
#include <set>
#include <thread>

namespace grouser::sweeps {

namespace fs = std::filesystem;

namespace {

using output::RunStatus;

/// Status of this run in the folder; pending if the folder has no such run by this program.
RunStatus statusOf(const fs::path& folder, const SweepRun& run) {
  const scene::Scene& scene = run.scene;
  const RunManifest manifest(folder);
  const std::optional<RunStatus> status = base::valueOf<RunStatus>(manifest.text("status"));
  if (manifest.text("branched_from") != (run.from ? run.from->text() : "")) return RunStatus::pending;
  if (!status || manifest.commit() != support::buildInfo().commit || manifest.text("inputs") != setup::inputsOf(scene))
    return RunStatus::pending;
  try {
    return identity(setup::loadScene(folder / "scene.toml")) == identity(scene) ? *status : RunStatus::pending;
  } catch (const base::InputError&) {
    return RunStatus::pending; // another version of the program wrote it, or it is damaged
  }
}

/// Throws if the folder contains something other than a run.
void checkRunFolder(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error)) return;
  const bool isOurs = fs::exists(folder / kRunLog, error); // a plain `grouser run` writes none
  if (!fs::is_directory(folder, error) || (!isOurs && !fs::is_empty(folder, error)))
    throw base::InputError(fmt::format(
        "{}: exists but is not the folder of a run; choose another with --out, or use it anyway with --force",
        folder.string()));
}

/// Throws if the folder is that of a run: a sweep would hide its results.
void requireNoRun(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder / "manifest.json", error))
    throw base::InputError(
        fmt::format("{}: contains the results of a run; choose another folder with --out", folder.string()));
}

base::Cause causeIn(const RunManifest& manifest) {
  return base::valueOf<base::Cause>(manifest.text("cause")).value_or(base::Cause::unknown);
}

/// Waits until no run writes to this folder: runs of a killed sweep still write their checkpoints.
void awaitFormer(const fs::path& folder) {
  constexpr auto kPatience = std::chrono::seconds(60);
  constexpr auto kLook = std::chrono::milliseconds(20);
  const auto begun = std::chrono::steady_clock::now();
  for (;; std::this_thread::sleep_for(kLook)) {
    support::FileLock lock;
    if (lock.take(folder)) return;
    if (std::chrono::steady_clock::now() - begun > kPatience) support::claimUnused(lock, folder);
  }
}

/// Reason why a run failed: the error message that the run printed, if any.
std::string reason(const support::ProcessEnd& end, const fs::path& log) {
  const std::string mark = "grouser: error: ";
  std::string message;
  std::ifstream file(log);
  for (std::string line; std::getline(file, line);)
    if (line.rfind(mark, 0) == 0) message = line.substr(mark.size());
  if (end.signal != 0) return end.text();
  return message.empty() ? fmt::format("{}; see {}", end.text(), log.string()) : message;
}

/// Whether a signal stopped the run, so that it can be resumed: exit code 128 + signal.
bool hasStopped(const support::ProcessEnd& end) { return end.status > 128; }

std::ptrdiff_t countEnded(const std::vector<SweepOutcome>& outcomes) {
  return std::count_if(outcomes.begin(), outcomes.end(),
                       [](const SweepOutcome& o) { return output::hasEnded(o.status); });
}

bool mayUseGpu(const SweepPlan& plan) {
  return std::any_of(plan.runs.begin(), plan.runs.end(),
                     [](const SweepRun& run) { return run.scene.run.device != support::DeviceChoice::cpu; });
}

/// Performs the runs of a sweep as processes, at most `jobs` at a time.
class Runner {
public:
  Runner(const SweepPlan& plan, const SweepOptions& options, const std::string& what, const OutcomesChanged& changed)
      : plan_(plan), options_(options), changed_(changed), gpus_(options.jobs > 1 && mayUseGpu(plan)),
        outcomes_(plan.runs.size()), work_(plan.runs.size()), timeOf_(plan.runs.size()), progress_(what) {
    for (std::size_t i = 0; i < plan.runs.size(); ++i) {
      const bool anew =
          options.force && std::find(options.made.begin(), options.made.end(), plan.runs[i].name) == options.made.end();
      const RunStatus former = anew ? RunStatus::pending : statusAtEnd(i);
      if (former == RunStatus::finished) {
        outcomes_[i].status = RunStatus::finished;
        progress_.note(fmt::format("{} already finished", title(i)));
      } else if (former == RunStatus::incomplete) {
        outcomes_[i] = {RunStatus::incomplete, RunManifest(folder(i)).text("incomplete")};
        progress_.note(fmt::format("{} already incomplete: {}", title(i), outcomes_[i].message));
      } else if (former == RunStatus::failed && options.keepFailures) {
        const RunManifest manifest(folder(i));
        outcomes_[i] = {RunStatus::failed, manifest.text("error"), causeIn(manifest)};
        progress_.note(fmt::format("{} has failed before: {}", title(i), outcomes_[i].message));
      } else {
        waiting_.push_back(i);
        work_[i] = stepWorkOf(plan.runs[i]), due_ += work_[i];
        timeOf_[i] = times_.add(plan.runs[i]);
        const bool isHalfDone = former == RunStatus::stopped || former == RunStatus::running; // killed
        std::error_code error;
        if (isHalfDone && fs::exists(folder(i) / storage::kCheckpointName, error)) goesOn_.insert(i);
      }
    }
    todo_ = waiting_.size();
    if (options.jobs > 1 && options.seconds == 0)
      std::stable_sort(waiting_.begin(), waiting_.end(),
                       [&](std::size_t a, std::size_t b) { return work_[a] > work_[b]; });
  }

  /// After an error: signals all runs to write checkpoints, then waits for each.
  ~Runner() {
    for (Running& run : running_) run.process.terminate();
  }
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  const std::vector<SweepOutcome>& outcomes() const { return outcomes_; }

  void run() {
    const support::StopSignals signals;
    changed_(outcomes_);
    std::size_t next = 0;
    const auto more = [&] { return next < waiting_.size() && !isLate(); };
    while (more() || !running_.empty()) {
      while (more() && running_.size() < static_cast<std::size_t>(options_.jobs)) launch(waiting_[next++]);
      reap();
      if (const int signal = support::StopSignals::received()) stop(signal);
      if (progress_.due()) report();
    }
    if (todo_ > 0)
      progress_.finish(
          fmt::format("{}{}", endedText(outcomes_), next < waiting_.size() ? "; repeat the command to continue" : ""));
  }

private:
  using Clock = std::chrono::steady_clock;
  struct Running {
    Running(std::size_t run, int gpu, const support::Program& program) : index(run), place(gpu), process(program) {}
    std::size_t index;
    int place; ///< slot among the concurrent runs
    Clock::time_point since = Clock::now();
    support::ChildProcess process;
  };

  fs::path folder(std::size_t i) const { return options_.folder / plan_.runs[i].name; }
  const fs::path& fileOf(std::size_t i) const { return plan_.runs[i].file.empty() ? plan_.scene : plan_.runs[i].file; }
  std::string title(std::size_t i) const {
    return fmt::format("run {} of {}  {:<28}", i + 1, plan_.runs.size(), plan_.runs[i].name);
  }
  /// Status of a run of an earlier sweep. Waits for runs of a killed sweep, which still write their checkpoints.
  RunStatus statusAtEnd(std::size_t i) const {
    const RunStatus now = statusOf(folder(i), plan_.runs[i]);
    if (now != RunStatus::running) return now;
    awaitFormer(folder(i));
    return statusOf(folder(i), plan_.runs[i]);
  }
  bool isLate() const {
    return options_.seconds > 0 && std::chrono::duration<double>(Clock::now() - begin_).count() > options_.seconds;
  }

  void launch(std::size_t i) {
    std::error_code error;
    fs::create_directories(folder(i), error);
    if (error)
      throw base::InputError(fmt::format("{}: cannot create the folder ({}); choose another with --out",
                                         folder(i).string(), error.message()));
    awaitFormer(folder(i));
    const bool continues = goesOn_.contains(i);
    // Results of an earlier run must not be mistaken for those of this one.
    if (!continues)
      for (const char* name : {"manifest.json", "results.h5", "timeseries.csv"}) fs::remove(folder(i) / name);
    support::Program program{{options_.program.string(), "run", fileOf(i).string()}};
    std::vector<std::string>& words = program.words;
    std::vector<std::string> overrides = plan_.runs[i].overrides;
    if (options_.jobs > 1 && plan_.runs[i].scene.run.threads == 0)
      putOverride(overrides, fmt::format("run.threads={}", std::max(1, base::cpuExec().threads / options_.jobs)));
    for (const std::string& o : overrides) words.insert(words.end(), {"--set", o});
    words.insert(words.end(), {"--out", folder(i).string(), continues ? "--resume" : "--force", "--hash"});
    if (plan_.runs[i].untilRest) words.insert(words.end(), {"--until", "rest"});
    if (const auto& from = plan_.runs[i].from; from && !continues) words.insert(words.end(), {"--resume", from->file});
    const int place = freePlace();
    program.environment = gpus_.environment();
    program.environment.emplace_back(support::kFirstGpu, support::firstGpuOf(place));
    program.log = folder(i) / kRunLog, program.append = continues;
    times_.begin(timeOf_[i], shareReached(i));
    if (continues) progress_.note(fmt::format("{} resumes from its checkpoint", title(i)));
    running_.emplace_back(i, place, program);
    outcomes_[i].status = RunStatus::running;
    changed_(outcomes_);
  }

  /// First free slot: the next run uses the GPU of a finished run.
  int freePlace() const {
    const auto isTaken = [&](int place) {
      return std::any_of(running_.begin(), running_.end(), [&](const Running& r) { return r.place == place; });
    };
    int place = 0;
    while (isTaken(place)) ++place;
    return place;
  }

  /// Waits 20 ms, and collects the results of finished runs.
  void reap() {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    for (auto it = running_.begin(); it != running_.end();) {
      const std::optional<support::ProcessEnd> end = it->process.ended();
      if (!end) {
        ++it;
        continue;
      }
      const std::size_t i = it->index;
      const double seconds = std::chrono::duration<double>(Clock::now() - it->since).count();
      it = running_.erase(it);
      if (!restarted(i, *end)) finish(i, *end, seconds);
    }
  }

  /// Restarts a run that could not be resumed, e.g. from a damaged checkpoint.
  bool restarted(std::size_t i, const support::ProcessEnd& end) {
    constexpr int kWrongInput = 2;
    if (stopping_ || !goesOn_.contains(i) || end.status != kWrongInput) return false;
    progress_.note(fmt::format("{} restarts: {}", title(i), reason(end, folder(i) / kRunLog)));
    goesOn_.erase(i);
    launch(i);
    return true;
  }

  /// Stops the runs: each finishes its current step and writes a checkpoint.
  void stop(int signal) {
    stopping_ = true;
    for (Running& run : running_) run.process.terminate();
    while (!running_.empty()) reap();
    if (countEnded(outcomes_) == static_cast<std::ptrdiff_t>(outcomes_.size())) return;
    throw support::Stopped(signal, fmt::format("stopped by {} after {} of {} runs", support::StopSignals::name(signal),
                                               countEnded(outcomes_), outcomes_.size()));
  }

  /// Share of the expected duration that a run has reached.
  double shareReached(std::size_t i) const {
    return std::min(1.0, timeReached(folder(i)) / expectedEnd(plan_.runs[i]));
  }

  void finish(std::size_t i, const support::ProcessEnd& end, double seconds) {
    ++ended_, done_ += work_[i];
    times_.end(timeOf_[i], base::kNaN, base::kNaN, base::kNaN);
    if (end.status == 0) {
      const RunManifest manifest(folder(i));
      times_.end(timeOf_[i], manifest.figure("wall_preparation_s"), manifest.figure("wall_settling_s"),
                 manifest.figure("wall_steps_s"));
      const bool whole = manifest.text("status") != base::wordOf(RunStatus::incomplete);
      outcomes_[i] = {whole ? RunStatus::finished : RunStatus::incomplete, manifest.text("incomplete")};
      progress_.note(fmt::format("{} {} in {}", title(i), base::wordOf(outcomes_[i].status),
                                 support::Progress::duration(seconds)));
    } else if (stopping_ || (support::StopSignals::received() && hasStopped(end))) { // Ctrl-C signals all of them
      outcomes_[i].status = RunStatus::stopped;
      progress_.note(fmt::format("{} stopped", title(i)));
    } else {
      outcomes_[i] = {RunStatus::failed, reason(end, folder(i) / kRunLog), causeIn(RunManifest(folder(i)))};
      progress_.note(fmt::format("{} failed: {}", title(i), outcomes_[i].message));
    }
    changed_(outcomes_);
  }

  void report() {
    double done = done_;
    std::string names;
    for (const Running& run : running_) {
      const double share = shareReached(run.index);
      done += work_[run.index] * share;
      times_.reach(timeOf_[run.index], share, std::chrono::duration<double>(Clock::now() - run.since).count());
      names += (names.empty() ? "" : "; ") + plan_.runs[run.index].name;
    }
    progress_.update(done / due_, fmt::format("{} of {} runs finished, now {}", ended_, todo_, names),
                     times_.left(options_.jobs));
  }

  const SweepPlan& plan_;
  const SweepOptions& options_;
  const OutcomesChanged& changed_;
  support::GpuSharing gpus_; ///< destroyed after the runs
  std::vector<SweepOutcome> outcomes_;
  std::vector<std::size_t> waiting_;
  std::set<std::size_t> goesOn_; ///< pending runs that have a checkpoint
  std::list<Running> running_;
  std::size_t todo_ = 0, ended_ = 0;
  bool stopping_ = false;
  std::vector<double> work_;        ///< stepWorkOf() of each pending run
  std::vector<std::size_t> timeOf_; ///< its index in times_
  RunTimes times_;
  double due_ = 0, done_ = 0; ///< total work of the pending runs, and of those that have ended
  Clock::time_point begin_ = Clock::now();
  support::Progress progress_;
};

} // namespace

Claim::Claim(const SweepOptions& options) : use_(options.use) {
  if (!options.shared) support::claimUnused(use_->lock, options.folder);
  ++use_->claims;
}

Claim::~Claim() {
  if (--use_->claims == 0) use_->lock.release();
}

std::string endedText(const std::vector<SweepOutcome>& outcomes) {
  const auto incomplete = std::count_if(outcomes.begin(), outcomes.end(),
                                        [](const SweepOutcome& o) { return o.status == RunStatus::incomplete; });
  return fmt::format("{} of {} {}", countEnded(outcomes), base::counted(outcomes.size(), "run"),
                     incomplete > 0 ? fmt::format("ended, {} incomplete", incomplete) : "finished");
}

std::string identity(scene::Scene scene) {
  scene.run.device = support::DeviceChoice::automatic, scene.run.threads = 0;
  scene.output.folder.clear();
  return scene::resolvedToml(scene);
}

std::vector<SweepOutcome> runMissing(const SweepPlan& plan, const SweepOptions& options, const std::string& what,
                                     const OutcomesChanged& changed) {
  requireNoRun(options.folder);
  support::firstGpuOf(0); // throws before results of earlier runs are removed
  for (const SweepRun& run : plan.runs) {
    if (!options.force) checkRunFolder(options.folder / run.name);
    if (run.scene.run.device == support::DeviceChoice::cuda && !base::cudaAvailable())
      base::cudaExec(); // throws with the reason
  }
  std::error_code error;
  fs::create_directories(options.folder, error);
  if (error || !fs::is_directory(options.folder))
    throw base::InputError(
        fmt::format("{}: cannot create the folder; choose another with --out", options.folder.string()));
  const Claim claim(options); // two sweeps in one folder would remove each other's files
  Runner runner(plan, options, what, changed);
  runner.run();
  return runner.outcomes();
}

} // namespace grouser::sweeps
