// SPDX-License-Identifier: BSD-3-Clause
#include "api/detail/run.hpp"
#include "runs/output/manifest.hpp"
#include "runs/session/failed_run.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/device_choice.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace grouser::detail {

namespace {

constexpr double kBetweenQuestions = 0.1; ///< that keepGoing is asked [s]

scene::Scene onDevice(const Scene::Impl& of, const Options& options) {
  std::vector<std::string> overrides = of.overrides;
  if (!options.device.empty()) overrides.push_back("run.device=" + options.device);
  if (options.threads >= 0) overrides.push_back(fmt::format("run.threads={}", options.threads));
  return of.text ? setup::parseScene(*of.text, of.file, overrides) : setup::loadScene(of.file, overrides);
}

session::RunRequest requestOf(const Options& options, const std::optional<std::filesystem::path>& resume) {
  session::RunRequest request;
  request.folder = options.folder, request.force = options.overwrite, request.cache = options.cache;
  request.resume = resume, request.hash = true, request.commandLine = "library";
  request.ranks = options.ranks ? &options.ranks->impl().ranks : nullptr;
  return request;
}

} // namespace

Run::Run(const Scene& of, const Options& given, const std::optional<std::filesystem::path>& resume)
    : scene(onDevice(of.impl(), given)), options(given), request(requestOf(given, resume)),
      record(setup::recordSetup(scene, setup::provenanceOf(scene))),
      exec(support::chooseDevice(scene.run.device, scene.run.threads, request.ranks)),
      kept(session::cachesOf(scene.terrain && scene.terrain->cache, request)),
      former(session::formerRun(record.provenance, request)) {
  coupling::SimulationSetup setup = setup::simulationSetup(scene, comm().size());
  coupling::SphereSets* spheres = kept.spheres ? &*kept.spheres : nullptr;
  if (former) {
    simulation = std::make_unique<coupling::Simulation>(std::move(setup), exec, former->state, comm(), spheres);
  } else {
    const coupling::SettleProgress progress = [this](double time, double agitation) {
      if (options.settling) options.settling(time, agitation);
    };
    simulation = std::make_unique<coupling::Simulation>(std::move(setup), exec, progress, comm(),
                                                        kept.beds ? &*kept.beds : nullptr, spheres);
  }
  simulation->restartMeans(coupling::Means::watch);
  if (options.folder.empty()) return;
  session.emplace(*simulation, record, request, exec, former.get(), std::numeric_limits<std::int64_t>::max() / 2);
  session->record([this] { session->begin(); });
}

const coupling::VehicleRig& Run::rig() const {
  if (!simulation->vehicle()) throw InputError("the scene has no vehicle; give it [vehicle] spec = \"vehicles/light_tracked.toml\"");
  return *simulation->vehicle();
}

void Run::set(const std::vector<coupling::Input>& inputs) const {
  translated([&] { simulation->set(inputs); });
}

void Run::setTracks(coupling::InputKind kind, double left, double right) const {
  std::vector<coupling::Input> inputs{{0, kind, 0, false, {left}}};
  if (rig().assembly().tracks.size() > 1) inputs.push_back({0, kind, 1, false, {right}});
  set(inputs);
}

void Run::release(std::initializer_list<coupling::InputKind> kinds,
                  const std::optional<std::int32_t>& target) const {
  std::vector<coupling::Input> acting;
  for (coupling::Input input : simulation->inputs().acting()) {
    const bool meant = std::find(kinds.begin(), kinds.end(), input.kind) != kinds.end();
    if (!meant || (target && input.target != *target)) continue;
    input.released = true, input.value = {};
    acting.push_back(input);
  }
  if (!acting.empty()) set(acting);
}

void Run::requireAlike() const {
  if (comm().alone()) return;
  const auto all = comm().gatherAll(simulation->inputs().save());
  for (std::size_t r = 1; r < all.size(); ++r)
    if (all[r] != all[0])
      throw InputError(fmt::format("step {}: rank {} has set other inputs than rank 0 ({} beside {} so far); all ranks "
                                   "must set the same before the same step",
                                   simulation->steps(), r, all[r].size() / coupling::Input::kNumbers,
                                   all[0].size() / coupling::Input::kNumbers));
}

void Run::step(std::int64_t count, const std::function<bool()>& keepGoing) {
  if (finished) throw InputError("the simulation is finished: it cannot be stepped any more");
  if (failed) throw InputError("the simulation has failed: it cannot be stepped any more; restore() a checkpoint");
  if (count < 1) throw InputError(fmt::format("step({}): at least one step", count));
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max() / 4;
  if (count > kMost) throw InputError(fmt::format("step({}): at most {} steps", count, kMost));
  if (const coupling::VehicleRig* rig = simulation->vehicle(); rig && !rig->ended().empty())
    throw InputError("the scene's [stop] has ended the run: " + rig->ended());
  requireAlike();
  simulation->restartMeans(coupling::Means::watch);
  const std::int64_t end = simulation->steps() + count;
  const auto goesOn = [&] {
    return simulation->steps() < end && !(simulation->vehicle() && !simulation->vehicle()->ended().empty());
  };
  support::Stopwatch asked;
  std::int64_t together = keepGoing ? 16 : count; // between two questions
  const auto advance = [&] {
    for (std::int64_t next = simulation->steps() + together; goesOn();) {
      const std::int64_t most = std::min(end, next) - simulation->steps();
      session ? session->advance(most) : static_cast<void>(simulation->advance(most));
      if (!keepGoing || simulation->steps() < next) continue;
      const double seconds = asked.seconds();
      if (seconds < 0.5 * kBetweenQuestions) together *= 2;
      if (seconds > 2 * kBetweenQuestions) together = std::max<std::int64_t>(1, together / 2);
      next = simulation->steps() + together;
      if (!keepGoing()) return;
      asked = {};
    }
  };
  failed = true; // unless it goes well, or what keepGoing throws ends it between two steps
  try {
    translated([&] { session ? session->record(advance) : advance(); });
  } catch (const Error&) {
    throw;
  } catch (...) {
    failed = false;
    throw;
  }
  failed = false;
}

void Run::finish() {
  if (finished || failed) return;
  finished = true;
  if (!session) return translated([this] { simulation->checkEnergy(); });
  translated([this] {
    session->record([this] {
      session->end();
      if (record.output.picture) session->recorder().picture(record.output.pictureWidth);
      output::Summary summary;
      summary.steps = simulation->steps(), summary.simulatedTime = simulation->time();
      summary.wallTime = since.seconds(), summary.stateHash = simulation->stateHash();
      session->writer().finish(summary);
    });
    session.reset(); // closes its files
    if (scene.output.plots && comm().first()) session::leavePlots(options.folder, scene.vehicle.has_value());
  });
}

} // namespace grouser::detail
