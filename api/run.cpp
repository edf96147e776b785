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

#include <algorithm>
#include <atomic>
#include <exception>
#include <fmt/format.h>
#include <limits>
#include <unistd.h>
#include <utility>

namespace grouser::detail {

namespace {

constexpr double kBetweenQuestions = 0.1; ///< interval between two calls of keepGoing [s]

/// Refuses forked processes: a fork does not copy the threads of GNU OpenMP; the child would hang in a parallel region.
void requireThreads(const base::Exec& exec) {
  static std::atomic<pid_t> withThreads{0};
  const pid_t before = withThreads.load();
  if (before != 0 && before != getpid())
    throw base::InputError(
        "a process forked after a multi-threaded simulation cannot run simulations: spawn the process instead "
        "(Python: multiprocessing.set_start_method(\"spawn\")), or use threads = 1 in the parent process");
  if (exec.onCpu() && exec.threads > 1) withThreads = getpid();
}

scene::Scene onDevice(const SceneData& of, const Options& options) {
  std::vector<std::string> overrides = of.overrides;
  if (!options.device.empty()) overrides.push_back("run.device=" + options.device);
  if (options.threads) overrides.push_back(fmt::format("run.threads={}", *options.threads));
  return setup::parseScene(of.text, of.file, overrides);
}

session::RunRequest requestOf(const Options& options, const std::optional<std::filesystem::path>& resume) {
  session::RunRequest request;
  request.folder = options.folder, request.force = options.overwrite, request.cache = options.cache;
  request.names = {"folder", "overwrite", "the checkpoint"}, request.resume = resume, request.hash = true;
  std::error_code error;
  request.branch =
      resume && !std::filesystem::equivalent(std::filesystem::absolute(*resume).parent_path(), options.folder, error);
  request.commandLine = "library", request.ranks = Run::ranksOf(options);
  return request;
}

/// Checks the folder before the bed settles.
void claim(const session::RunRequest& request, support::FileLock& lock) {
  if (request.folder.empty() || !request.comm().first()) return;
  if (request.resume && !request.branch) return output::claimFolder(lock, request.folder, request.names);
  output::checkOutputFolder(request.folder, request.force, request.names);
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
    const coupling::SettleProgress progress = [this](double time, double energyRatio) {
      if (options.settling) options.settling(time, energyRatio);
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
    session->stop(fmt::format("destroyed at {:.6g} s without finish()", simulation->time()));
  } catch (const std::exception&) {
    // The manifest cannot be written, for example because the disk is full.
  }
}

std::unique_ptr<storage::Checkpoint> Run::goOn() {
  auto read = session::formerRun(record.provenance, request);
  coupling::SimulationSetup setup = setup::simulationSetup(scene, comm().size());
  session::requireSameStep(*read, setup.timeStep, record.provenance, request);
  if (request.branch) session::branch(*read, record.provenance, setup, request);
  simulation.reset(); // memory may not hold two simulations
  simulation = session::makeSimulation(std::move(setup), record, exec, read.get(), request, kept);
  pending.clear();
  return read;
}

coupling::Simulation& Run::now() const {
  if (!simulation) throw InputError("the last restore() failed and left no valid simulation; create a new one");
  return *simulation;
}

const coupling::VehicleRig& Run::rig() const {
  const coupling::VehicleRig* rig = now().vehicle();
  if (!rig) throw InputError("the scene has no vehicle; add [vehicle] spec = \"vehicles/light_tracked.toml\"");
  return *rig;
}

void Run::requireOpen(const char* what) const {
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
  // An engine has either a throttle or a governor.
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
        throw InputError(fmt::format("step {}: rank {} and rank 0 differ in their inputs or number of steps; "
                                     "set the same inputs and step count on all ranks",
                                     now().steps(), r));
  }
  if (!inputs.empty()) translated([&] { now().set(inputs); });
}

void Run::step(std::int64_t count, const std::function<bool()>& keepGoing) {
  if (isStepping) throw InputError("step() was called within step(); return from keepGoing first");
  requireOpen("step()");
  translated([this] { requireThreads(exec); });
  if (count < 1) throw InputError(fmt::format("step({}): count must be at least 1", count));
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max() / 4;
  if (count > kMax) throw InputError(fmt::format("step({}): count must be at most {}", count, kMax));
  if (const coupling::VehicleRig* rig = now().vehicle(); rig && !rig->ended().empty())
    throw InputError("the scene's [stop] has ended the run: " + rig->ended());
  act(count);
  now().restartMeans(coupling::Means::watch);
  std::exception_ptr thrown; // by keepGoing, between two steps; the simulation remains valid
  isStepping = true;
  try {
    const auto all = [&] { thrown = advance(count, keepGoing); };
    translated([&] { session ? session->record(all) : all(); });
  } catch (const std::exception& error) {
    isStepping = false, failed = error.what();
    throw;
  }
  isStepping = false;
  if (thrown) std::rethrow_exception(thrown);
}

std::exception_ptr Run::advance(std::int64_t count, const std::function<bool()>& keepGoing) {
  const std::int64_t end = now().steps() + count;
  const auto continues = [&] { return now().steps() < end && !(now().vehicle() && !now().vehicle()->ended().empty()); };
  std::exception_ptr thrown;
  const auto stops = [&] {
    try {
      return !keepGoing();
    } catch (...) {
      thrown = std::current_exception();
      return true;
    }
  };
  // All ranks must call keepGoing at the same steps, although their clocks differ.
  constexpr std::int64_t kOfRanks = 16;
  while (continues()) {
    const support::Stopwatch lap;
    const std::int64_t next =
        keepGoing ? std::min(end, now().steps() + (comm().alone() ? stepsAtATime : kOfRanks)) : end;
    while (now().steps() < next && continues()) {
      const std::int64_t most = next - now().steps();
      session ? session->advance(most) : static_cast<void>(now().advance(most));
    }
    if (!keepGoing) continue;
    if (lap.seconds() < 0.5 * kBetweenQuestions && next < end) stepsAtATime *= 2;
    if (lap.seconds() > 2 * kBetweenQuestions) stepsAtATime = std::max<std::int64_t>(1, stepsAtATime / 2);
    if (comm().sumOf(stops() ? 1 : 0) > 0) return thrown;
  }
  return thrown;
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
