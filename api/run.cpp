// SPDX-License-Identifier: BSD-3-Clause
#include "api/detail/run.hpp"
#include "runs/output/manifest.hpp"
#include "runs/session/branch.hpp"
#include "runs/session/failed_run.hpp"
#include "runs/session/final_figures.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/output_place.hpp"

#include <algorithm>
#include <atomic>
#include <fmt/format.h>
#include <limits>
#include <string_view>
#include <unistd.h>
#include <utility>

namespace grouser::detail {

namespace {

constexpr double kBetweenQuestions = 0.1; ///< that keepGoing is asked [s]

/// OpenMP of GNU does not survive a fork: its threads are gone in the child, which waits for them for ever.
void requireThreads(const base::Exec& exec) {
  static std::atomic<pid_t> withThreads{0};
  const pid_t before = withThreads.load();
  if (before != 0 && before != getpid())
    throw base::InputError("this process was forked from one that has run a simulation on several threads, and cannot run "
                           "any: start it anew instead (Python: multiprocessing.set_start_method(\"spawn\")), or use "
                           "threads = 1 before");
  if (exec.onCpu() && exec.threads > 1) withThreads = getpid();
}

scene::Scene onDevice(const SceneData& of, const Options& options) {
  constexpr int kMostThreads = 1024;
  if (options.threads < -1 || options.threads > kMostThreads)
    throw base::InputError(fmt::format("threads = {}: a number from 0 (all cores) to {}, or -1 (as in the scene)",
                                       options.threads, kMostThreads));
  std::vector<std::string> overrides = of.overrides;
  if (!options.device.empty()) overrides.push_back("run.device=" + options.device);
  if (options.threads >= 0) overrides.push_back(fmt::format("run.threads={}", options.threads));
  return setup::parseScene(of.text, of.file, overrides);
}

bool isSameFolder(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  return std::filesystem::weakly_canonical(a, error) == std::filesystem::weakly_canonical(b, error);
}

session::RunRequest requestOf(const Options& options, const std::optional<std::filesystem::path>& resume) {
  session::RunRequest request;
  request.folder = options.folder, request.force = options.overwrite, request.cache = options.cache;
  request.resume = resume, request.resumeOption = "the checkpoint", request.hash = true;
  request.branch = resume && (options.folder.empty() || !isSameFolder(resume->parent_path(), options.folder));
  request.commandLine = "library", request.ranks = Run::ranksOf(options);
  return request;
}

/// Before a bed settles for nothing.
void claim(const session::RunRequest& request, support::FileLock& lock) {
  std::error_code error;
  if (request.folder.empty() || !request.comm().first()) return;
  if (request.resume && !request.branch) return output::claimFolder(lock, request.folder);
  support::requireFolder(request.folder);
  if (!request.force && std::filesystem::exists(request.folder, error) &&
      !std::filesystem::is_empty(request.folder, error))
    throw base::InputError(fmt::format("{}: the folder is not empty; name another, or let it be overwritten (overwrite)",
                                       request.folder.string()));
}

} // namespace

Run::Run(const Scene& of, const Options& given, const std::optional<std::filesystem::path>& resume)
    : scene(onDevice(dataOf(of), given)), options(given), request(requestOf(given, resume)),
      record(setup::recordSetup(scene, setup::provenanceOf(scene))),
      exec(support::chooseDevice(scene.run.device, scene.run.threads, request.ranks)),
      kept(session::cachesOf(scene.terrain && scene.terrain->cache, request)) {
  requireThreads(exec);
  claim(request, lock);
  std::unique_ptr<storage::Checkpoint> former;
  if (resume) {
    former = goOn();
  } else {
    const coupling::SettleProgress progress = [this](double time, double agitation) {
      if (options.settling) options.settling(time, agitation);
    };
    simulation = std::make_unique<coupling::Simulation>(setup::simulationSetup(scene, comm().size()), exec, progress,
                                                        comm(), kept.beds ? &*kept.beds : nullptr,
                                                        kept.spheres ? &*kept.spheres : nullptr);
  }
  simulation->restartMeans(coupling::Means::watch);
  if (options.folder.empty()) return;
  session.emplace(*simulation, record, request, exec, former.get(), std::numeric_limits<std::int64_t>::max() / 2);
  session->record([this] { session->begin(); });
}

Run::~Run() {
  if (!session || finished || !failed.empty()) return;
  try {
    session->stop(fmt::format("left at {:.6g} s without finish()", simulation->time()));
  } catch (const std::exception&) {
    // A full disk, say.
  }
}

std::unique_ptr<storage::Checkpoint> Run::goOn() {
  auto read = session::formerRun(record.provenance, request);
  coupling::SimulationSetup setup = setup::simulationSetup(scene, comm().size());
  if (read->timeStep != setup.timeStep)
    throw base::InputError(fmt::format("{}: was written with steps of {:g} s, this scene takes {:g} s; give run.time_step",
                                       request.resume->string(), read->timeStep, setup.timeStep));
  if (request.branch) session::branch(*read, record.provenance, setup, request);
  simulation.reset(); // memory may not hold two of them
  simulation = std::make_unique<coupling::Simulation>(std::move(setup), exec, read->state, comm(),
                                                      kept.spheres ? &*kept.spheres : nullptr);
  pending.clear();
  return read;
}

coupling::Simulation& Run::now() const {
  if (!simulation) throw InputError("the simulation is lost, since the last restore() failed midway; make another");
  return *simulation;
}

const coupling::VehicleRig& Run::rig() const {
  const coupling::VehicleRig* rig = now().vehicle();
  if (!rig) throw InputError("the scene has no vehicle; give it [vehicle] spec = \"vehicles/light_tracked.toml\"");
  return *rig;
}

void Run::requireOpen(const char* what) const {
  if (isStepping && std::string_view(what) == "step()")
    throw InputError("step() was called by the function that step() calls; return from that first");
  if (finished) throw InputError(fmt::format("{}: the simulation is finished; restore() a checkpoint", what));
  if (!failed.empty())
    throw InputError(fmt::format("{}: the simulation has failed; restore() a checkpoint. The cause: {}", what, failed));
}

void Run::set(const std::vector<coupling::Input>& inputs) {
  requireOpen("setting inputs");
  translated([&] {
    for (const coupling::Input& input : inputs) coupling::require(now(), input);
  });
  pending.insert(pending.end(), inputs.begin(), inputs.end());
  if (comm().alone()) act();
}

void Run::setTracks(coupling::InputKind kind, double left, double right) {
  using coupling::InputKind;
  std::vector<coupling::Input> inputs{{0, kind, 0, false, {left}}};
  if (rig().assembly().tracks.size() > 1) inputs.push_back({0, kind, 1, false, {right}});
  set(inputs);
  // The last one counts: an engine has either a throttle or a governor.
  if (kind == InputKind::throttle) release({InputKind::sprocketSpeed});
  if (kind == InputKind::sprocketSpeed) release({InputKind::throttle});
}

void Run::release(std::initializer_list<coupling::InputKind> kinds, const std::optional<std::int32_t>& target) {
  std::vector<coupling::Input> acting = now().inputs().acting();
  acting.insert(acting.end(), pending.begin(), pending.end());
  std::vector<coupling::Input> released;
  for (coupling::Input input : acting) {
    const bool meant = std::find(kinds.begin(), kinds.end(), input.kind) != kinds.end();
    if (!meant || (target && input.target != *target)) continue;
    input.released = true, input.value = {};
    released.push_back(input);
  }
  if (!released.empty()) set(released);
}

void Run::act(std::int64_t steps) {
  const std::vector<coupling::Input> inputs = std::exchange(pending, {});
  if (!comm().alone()) {
    std::vector<double> mine{static_cast<double>(steps)};
    for (const coupling::Input& input : inputs) {
      const auto numbers = input.numbers();
      mine.insert(mine.end(), numbers.begin(), numbers.end());
    }
    const auto all = comm().gatherAll(mine);
    for (std::size_t r = 1; r < all.size(); ++r)
      if (all[r] != all[0])
        throw InputError(fmt::format("step {}: rank {} has set other inputs than rank 0, or takes another number of "
                                     "steps; all ranks must set the same and step alike",
                                     now().steps(), r));
  }
  if (!inputs.empty()) translated([&] { now().set(inputs); });
}

void Run::step(std::int64_t count, const std::function<bool()>& keepGoing) {
  requireOpen("step()");
  translated([this] { requireThreads(exec); });
  if (count < 1) throw InputError(fmt::format("step({}): at least one step", count));
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max() / 4;
  if (count > kMost) throw InputError(fmt::format("step({}): at most {} steps", count, kMost));
  if (const coupling::VehicleRig* rig = now().vehicle(); rig && !rig->ended().empty())
    throw InputError("the scene's [stop] has ended the run: " + rig->ended());
  act(count);
  now().restartMeans(coupling::Means::watch);
  isStepping = true;
  failed = "an exception"; // unless it goes well, or what keepGoing throws ends it between two steps
  try {
    const auto all = [&] { advance(count, keepGoing); };
    translated([&] { session ? session->record(all) : all(); });
  } catch (const Error& error) {
    isStepping = false, failed = error.what();
    throw;
  } catch (...) {
    isStepping = false, failed.clear();
    throw;
  }
  isStepping = false, failed.clear();
}

void Run::advance(std::int64_t count, const std::function<bool()>& keepGoing) {
  const std::int64_t end = now().steps() + count;
  const auto goesOn = [&] {
    return now().steps() < end && !(now().vehicle() && !now().vehicle()->ended().empty());
  };
  // Ranks must be asked at the same step, which their clocks would not find.
  constexpr std::int64_t kOfRanks = 16;
  while (goesOn()) {
    const support::Stopwatch lap;
    const std::int64_t next =
        keepGoing ? std::min(end, now().steps() + (comm().alone() ? stepsAtATime : kOfRanks)) : end;
    while (now().steps() < next && goesOn()) {
      const std::int64_t most = next - now().steps();
      session ? session->advance(most) : static_cast<void>(now().advance(most));
    }
    if (!keepGoing) continue;
    if (lap.seconds() < 0.5 * kBetweenQuestions && next < end) stepsAtATime *= 2;
    if (lap.seconds() > 2 * kBetweenQuestions) stepsAtATime = std::max<std::int64_t>(1, stepsAtATime / 2);
    if (comm().sumOf(keepGoing() ? 0 : 1) > 0) return;
  }
}

void Run::finish() {
  if (finished || !failed.empty()) return;
  act();
  finished = true;
  if (!session) return translated([this] { now().checkEnergy(); });
  translated([this] {
    session->record([this] {
      session->end();
      if (record.output.picture) session->recorder().picture(record.output.pictureWidth);
      output::Summary summary;
      summary.steps = now().steps(), summary.simulatedTime = now().time();
      summary.wallTime = since.seconds(), summary.stateHash = now().stateHash();
      session::noteFigures(*session, summary);
      session->writer().finish(summary);
    });
    session.reset(); // closes its files
    if (scene.output.plots && comm().first()) session::leavePlots(options.folder, scene.vehicle.has_value());
  });
}

} // namespace grouser::detail
