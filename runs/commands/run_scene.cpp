// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/run_scene.hpp"

#include "base/error.hpp"
#include "runs/commands/bed_text.hpp"
#include "runs/commands/bed_warnings.hpp"
#include "runs/commands/checkpoints.hpp"
#include "runs/commands/failed_run.hpp"
#include "runs/commands/ledger_text.hpp"
#include "runs/commands/ranks_alike.hpp"
#include "runs/commands/recorder.hpp"
#include "runs/commands/run_warnings.hpp"
#include "runs/commands/signal_watch.hpp"
#include "runs/forecast/machine_fit.hpp"
#include "runs/output/mechanism_output.hpp"
#include "runs/setup/drive_length.hpp"
#include "runs/setup/vehicle_surroundings.hpp"
#include "runs/simulation/checkpoint.hpp"
#include "runs/simulation/mechanism.hpp"
#include "runs/simulation/simulation.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/not_written.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/stopwatch.hpp"
#include "runs/support/tell.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace grouser::commands {

namespace {

using support::Stopwatch;

/// Of all threads of this process since it began [s].
double cpuTime() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// How the grains are divided among the ranks.
void describeRanks(const simulation::Simulation& simulation) {
  const auto& grains = simulation.ground().grains;
  if (!grains || !grains->distribution()) return;
  const terrain::Subdomain& mine = grains->distribution()->subdomain();
  const base::Comm& comm = simulation.comm();
  const auto own = comm.gatherValue(static_cast<std::int64_t>(grains->view().count - mine.ghosts()));
  const auto ghosts = static_cast<double>(comm.sumOf(static_cast<std::int64_t>(mine.ghosts())));
  const auto& shape = mine.partition().shape();
  fmt::print("ranks     {}: subdomains {} x {} x {}, {} to {} grains each, {:.1f} % ghosts\n", comm.size(), shape[0],
             shape[1], shape[2], *std::min_element(own.begin(), own.end()), *std::max_element(own.begin(), own.end()),
             100 * ghosts / static_cast<double>(grains->count()));
}

/// How well the work was shared while driving. `waiting`: this rank's share of that time that it waited [-].
void describeSharing(const simulation::Simulation& simulation, double waiting, output::Summary& summary) {
  const auto& grains = simulation.ground().grains;
  const base::Comm& comm = simulation.comm();
  if (!grains || !grains->distribution()) return;
  const std::vector<double> waited = comm.gatherValue(waiting);
  const double least = *std::min_element(waited.begin(), waited.end()),
               most = *std::max_element(waited.begin(), waited.end());
  fmt::print("ranks     waited for others {:.1f} to {:.1f} % of the time; cuts moved {} times\n", 100 * least,
             100 * most, grains->distribution()->rebalancings());
  summary.figures["rank_waiting_least"] = least;
  summary.figures["rank_waiting_most"] = most;
  summary.figures["rebalancings"] = static_cast<double>(grains->distribution()->rebalancings());
}

/// Where what stands on a settled bed has been put.
void describePlaced(const simulation::Simulation& simulation) {
  const setup::GroundSetup& ground = simulation.setup().ground;
  for (const setup::SurfaceSetup& s : ground.surfaces)
    if (s.placedLater)
      fmt::print("placed    {} at ({:.6g}, {:.6g}, {:.6g}) m{}\n", s.name, s.start.position.x, s.start.position.y,
                 s.start.position.z, s.aboveBed ? fmt::format(", {:g} m above the bed", *s.aboveBed) : "");
  if (!ground.grains || ground.grains->onBed.empty()) return;
  std::size_t grains = 0;
  for (const setup::PlacedGrains& p : ground.grains->onBed) grains += p.grains.size();
  fmt::print("placed    {} grain{} on the settled bed\n", grains, grains == 1 ? "" : "s");
}

/// Where earlier runs may have left what this one needs; null: nothing is kept.
struct Caches {
  std::optional<simulation::BedCache> beds;
  std::optional<simulation::SphereCache> spheres;
  double settling = 0; ///< wall time that the bed of this run took, where none was kept [s]
};

Caches cachesOf(const scene::Scene& scene, const RunRequest& options) {
  Caches kept;
  const std::optional<support::KeptFiles> files =
      options.cache ? support::KeptFiles::ofUser(options.comm()) : std::nullopt;
  if (!files) return kept;
  if (scene.terrain && scene.terrain->cache) kept.beds.emplace(*files);
  kept.spheres.emplace(*files);
  return kept;
}

void describeBuild(const simulation::Simulation& simulation, const base::Exec& exec, const Caches& kept) {
  fmt::print("device    {}\n", base::describe(exec));
  if (const auto& grains = simulation.ground().grains)
    fmt::print("grains    {}, {:.0f} bytes each\n", grainsText(*grains),
               static_cast<double>(grains->system().deviceBytes()) /
                   static_cast<double>(std::max<std::size_t>(1, grains->view().count)));
  describeRanks(simulation);
  for (const scene::SoilUse& use : simulation.setup().provenance.soils)
    fmt::print("soil      {}\n", scene::soilLine(use));
  fmt::print("{}", bedText(simulation));
  describePlaced(simulation);
  if (kept.beds && !kept.beds->summary().empty()) fmt::print("bed       {}\n", kept.beds->summary());
  const std::string sets = kept.spheres ? kept.spheres->summary(simulation.comm()) : "";
  if (!sets.empty()) fmt::print("spheres   {}\n", sets);
  if (const simulation::VehicleRig* rig = simulation.vehicle()) {
    fmt::print("vehicle   {:.0f} kg, {} bodies, {} spheres ({} unique sets)\n", rig->assembly().mass,
               rig->assembly().model.bodies().size(), rig->parts().totalSpheres(), rig->parts().setFigures().size());
    if (simulation.ground().grains && simulation.setup().vehicle->soilMeetsShoesAlone)
      fmt::print(
          "soil      meets the shoes alone (vehicle.soil_meets): wheels, sprocket, rollers and idler pass through "
          "it\n");
  }
  for (const std::string& note : bedNotes(simulation)) fmt::print("note      {}\n", note);
  if (const simulation::Mechanism* mechanism = simulation.mechanism())
    fmt::print("{}", output::mechanismSize(*mechanism));
  std::fflush(stdout);
}

/// Reads the checkpoint of a run to be resumed; null for one from the start.
std::unique_ptr<simulation::Checkpoint> formerRun(const setup::Provenance& provenance, const RunRequest& options) {
  if (!options.resume) return nullptr;
  auto former = std::make_unique<simulation::Checkpoint>(simulation::readCheckpoint(*options.resume, options.comm()));
  simulation::checkSameScene(*former, *options.resume, provenance);
  if (former->commit != support::buildInfo().commit && options.comm().first())
    support::tell(
        "grouser: warning: {} was written by commit {}, this is {}; the bits are the same only if the physics "
        "are\n",
        options.resume->string(), former->commit, support::buildInfo().commit);
  return former;
}

/// At the checkpoint, or at the start: then the bed is settled first.
std::unique_ptr<simulation::Simulation> makeSimulation(setup::SimulationSetup setup, const base::Exec& exec,
                                                       const simulation::Checkpoint* former, const RunRequest& options,
                                                       Caches& kept) {
  const base::Comm comm = options.comm();
  simulation::BedCache* beds = kept.beds ? &*kept.beds : nullptr;
  simulation::SphereCache* spheres = kept.spheres ? &*kept.spheres : nullptr;
  if (former) return std::make_unique<simulation::Simulation>(std::move(setup), exec, former->state, comm, spheres);
  const bool hasBed = setup.ground.grains && setup.ground.grains->bed;
  const double limit = hasBed ? setup.ground.grains->bed->settle.timeLimit : 0;
  std::unique_ptr<support::Progress> settling;
  std::optional<Stopwatch> begun;
  FailedBed failed(setup, options, exec);
  simulation::SettleProgress settle = [&](double time, double agitation) {
    if (const int signal = SignalWatch(comm).receivedAt(0))
      throw support::Stopped(
          signal,
          fmt::format("stopped by {} while the bed settled; nothing was written", support::StopSignals::name(signal)),
          support::Stopped::Left::nothing);
    if (!settling)
      settling = std::make_unique<support::Progress>("settling", comm.first(), 0, support::Progress::End::limit);
    if (time > 0 && !begun) begun.emplace(); // before that it waits for another run
    if (begun) kept.settling = begun->seconds();
    settling->update(time / limit, fmt::format("t {:.2f} s, agitation {:.2g}", time, agitation));
  };
  settle.failed = [&](const terrain::Grains& bed, const std::string& message) { failed.leave(&bed, message); };
  try {
    auto simulation = std::make_unique<simulation::Simulation>(std::move(setup), exec, settle, comm, beds, spheres);
    if (settling) settling->finish("at rest");
    return simulation;
  } catch (const base::SimulationError& error) {
    failed.leave(nullptr, error.what());
    throw;
  }
}

/// Steps to the end, with rows, frames and checkpoints on the way. Throws Stopped where a signal came.
void drive(simulation::Simulation& simulation, Recorder& recorder, Checkpoints& checkpoints, std::int64_t total) {
  const setup::RunSetup& run = simulation.setup().run;
  const double dt = simulation.timeStep();
  const auto stepsOf = [dt](double interval) { return std::max<std::int64_t>(1, std::llround(interval / dt)); };
  const std::int64_t rowEvery = stepsOf(run.outputInterval), frameEvery = stepsOf(run.frameInterval);
  const std::int64_t saveEvery = run.checkpointInterval > 0 ? stepsOf(run.checkpointInterval) : total + 1;
  const simulation::VehicleRig* rig = simulation.vehicle();
  const setup::StopSetup stop = rig ? simulation.setup().vehicle->stop : setup::StopSetup{};
  const bool mayStop = stop.distance || stop.edge || stop.immobile;
  support::Progress progress("running", simulation.comm().first(),
                             static_cast<double>(simulation.steps()) / static_cast<double>(total),
                             mayStop ? support::Progress::End::limit : support::Progress::End::expected);
  SignalWatch signals(simulation.comm());
  while (simulation.steps() < total && !(rig && !rig->ended().empty())) {
    const std::int64_t now = simulation.steps();
    simulation.advance(
        std::min({total - now, rowEvery - now % rowEvery, frameEvery - now % frameEvery, saveEvery - now % saveEvery}));
    if (simulation.steps() % rowEvery == 0) recorder.row();
    if (simulation.steps() % frameEvery == 0) recorder.frame();
    if (simulation.steps() % rowEvery == 0) checkpoints.remember(simulation, recorder.writer());
    if (simulation.steps() % saveEvery == 0) checkpoints.write(simulation, recorder.writer());
    if (const int signal = signals.receivedAt(simulation.steps())) {
      checkpoints.write(simulation, recorder.writer());
      throw support::Stopped(signal, fmt::format("stopped by {} at {:.6g} s ({})", support::StopSignals::name(signal),
                                                 simulation.time(), checkpoints.last()));
    }
    if (progress.due())
      progress.update(static_cast<double>(simulation.steps()) / static_cast<double>(total),
                      fmt::format("t {:.3f} of {:g} s", simulation.time(), static_cast<double>(total) * dt));
  }
  simulation.checkEnergy(); // the end may fall between two looks
  // Before the last row: a run that goes on from here does not have it.
  checkpoints.write(simulation, recorder.writer());
  // The end is always written, whether or not the intervals meet it.
  if (simulation.steps() % rowEvery != 0) recorder.row();
  if (simulation.steps() % frameEvery != 0) recorder.frame();
  recorder.finalSurface();
  progress.finish(fmt::format("{} step{}", simulation.steps(), simulation.steps() == 1 ? "" : "s"));
}

/// Where the run has met a fault: the state before it as a checkpoint, and all as it is now as frame and picture.
void leaveState(simulation::Simulation& simulation, Recorder& recorder, Checkpoints& checkpoints) {
  if (!simulation.comm().alone()) return; // not all ranks need have met it
  try {
    checkpoints.writeRemembered(simulation, recorder.writer());
    recorder.lastFrame();
    if (simulation.setup().output.picture) recorder.picture(simulation.setup().output.pictureWidth);
  } catch (const std::exception&) {
    // The user gets the error that ended the run, not this one.
  }
}

std::string withCheckpoint(const std::string& message, const Checkpoints& checkpoints) {
  const std::string last = checkpoints.last();
  return last.empty() ? message : fmt::format("{} (last checkpoint: {})", message, last);
}

/// Where a file could not be written, or the device failed: the last good state, which the host has, if there is room
/// for that.
void leaveCheckpoint(const simulation::Simulation& simulation, Recorder& recorder, Checkpoints& checkpoints) {
  if (!simulation.comm().alone()) return;
  try {
    checkpoints.writeRemembered(simulation, recorder.writer());
  } catch (const std::exception&) {
    // The user gets the error that ended the run, not this one.
  }
}

/// Ends the run by this error, which names the checkpoint that is left.
template <class Error> [[noreturn]] void abandon(const std::string& what, Recorder& recorder, Checkpoints& left) {
  const std::string message = withCheckpoint(what, left);
  recorder.writer().abandon(message);
  throw Error(message);
}

/// All that is written of a run once its folder is there. What ends the run early is left in the folder.
template <class Write>
void record(simulation::Simulation& simulation, Recorder& recorder, Checkpoints& checkpoints, const Write& write) {
  try {
    write();
  } catch (const support::Stopped& stopped) {
    recorder.writer().stop(stopped.what());
    throw;
  } catch (const base::SimulationError& error) {
    leaveState(simulation, recorder, checkpoints);
    abandon<base::SimulationError>(error.what(), recorder, checkpoints);
  } catch (const support::NotWritten& error) {
    leaveCheckpoint(simulation, recorder, checkpoints);
    abandon<support::NotWritten>(error.what(), recorder, checkpoints);
  } catch (const base::DeviceError& error) {
    leaveCheckpoint(simulation, recorder, checkpoints);
    abandon<base::DeviceError>(
        fmt::format("step {}, time {:.4g} s: {}", simulation.steps(), simulation.time(), error.what()), recorder,
        checkpoints);
  } catch (const std::exception& error) {
    recorder.writer().abandon(error.what());
    throw;
  }
}

/// Share of weight x time that crushing may cut off before its loads say little [-].
constexpr double kSuspect = 0.01;

/// Grains that are squeezed or crush do not end a run; they are shown.
void describeSqueezed(simulation::Simulation& simulation, Recorder& recorder, output::Summary& summary) {
  if (simulation.setup().crushes()) {
    const double cut = simulation.ledger().cutImpulse;
    std::string share;
    if (const simulation::VehicleRig* rig = simulation.vehicle()) {
      const double of = cut / (rig->assembly().mass * norm(simulation.setup().gravity) * simulation.time());
      share = fmt::format(", {:.3g} % of weight x time{}", 100 * of,
                          of > kSuspect ? ": the run is suspect; take larger or stronger grains" : "");
      summary.figures["crushing_cut_over_weight"] = of;
    }
    fmt::print("crushing  has cut off {:.4g} N s{}\n", cut, share);
    summary.figures["crushing_cut_impulse"] = cut;
    const simulation::TakenOut& gone = simulation.takenOut();
    if (gone.grains > 0)
      fmt::print("crushed   {:g} grains of {:.4g} kg, taken out with {:.4g} J and ({:.2g}, {:.2g}, {:.2g}) N s\n",
                 gone.grains, gone.mass, gone.energy, gone.momentum.x, gone.momentum.y, gone.momentum.z);
    summary.figures["crushed_grains"] = gone.grains, summary.figures["crushed_mass_kg"] = gone.mass;
    summary.figures["crushed_energy_J"] = gone.energy;
  }
  const SqueezedRecord& squeezed = recorder.squeezed();
  const std::string text = squeezed.text();
  if (text.empty()) return;
  fmt::print("{}", text);
  summary.figures["squeezed_pairs_most"] = squeezed.pairs;
  summary.figures["squeezed_at_boundaries_most"] = squeezed.atBoundaries;
  summary.figures["squeezed_by_parts_most"] = squeezed.byParts;
  if (squeezed.share > 0) recorder.writer().fact("deepest_in_a_part", squeezed.deepest());
}

/// What steps an error chose.
void describeSteps(const simulation::Mechanism& mechanism, output::Summary& summary) {
  if (!mechanism.controller()) return;
  const simulation::StepController::Record& r = mechanism.controller()->record();
  fmt::print("steps     {} of {:.3g} to {:.3g} s of the mechanism's own, {} stretches done again\n", r.taken,
             r.smallest, r.largest, r.rejected);
  summary.figures["mechanism_steps"] = static_cast<double>(r.taken);
  summary.figures["mechanism_stretches_rejected"] = static_cast<double>(r.rejected);
  summary.figures["mechanism_step_smallest_s"] = r.smallest;
  summary.figures["mechanism_step_largest_s"] = r.largest;
}

/// `hasFolder`: whether it came so far that the folder is that of this run.
output::Summary runInFolder(const scene::Scene& scene, const setup::Provenance& provenance, const RunRequest& options,
                            bool& hasFolder) {
  const Stopwatch whole;
  const support::StopSignals signals;
  const base::Comm comm = options.comm();
  requireAlike(provenance, options.commandLine, comm);
  const base::Exec exec = support::chooseDevice(scene.run.device, scene.run.threads, options.ranks);
  forecast::requireFit(scene, exec, options.folder, options.force, !options.resume, options.ranks);
  support::FileLock folder; // of a run that goes on; one that begins makes its folder later
  if (options.resume && comm.first()) output::claimFolder(folder, options.folder);
  const std::unique_ptr<simulation::Checkpoint> former = formerRun(provenance, options);
  if (!former && comm.first()) warnOfTerrain(scene); // before a bed settles
  Caches kept = cachesOf(scene, options);
  const std::unique_ptr<simulation::Simulation> made =
      makeSimulation(setup::simulationSetup(scene, provenance, comm.size()), exec, former.get(), options, kept);
  simulation::Simulation& simulation = *made;
  const setup::SimulationSetup& setup = simulation.setup();
  const std::int64_t all = std::llround(setup.run.duration / setup.timeStep), begin = simulation.steps(),
                     total = std::min(all, options.steps.value_or(all));
  if (begin > total)
    throw base::InputError(fmt::format("{}: is at step {}, this run ends at step {}; raise run.duration or --steps",
                                       options.resume->string(), begin, total));
  const double prepared = whole.seconds();
  const std::vector<std::string> ofBed = bedWarnings(scene, simulation);
  if (comm.first())
    for (const std::string& warning : ofBed) support::tell("WARNING: {}\n", warning);
  describeBuild(simulation, exec, kept);
  if (!former && comm.first()) warnOf(scene, simulation);
  Recorder recorder(simulation, options, exec, former.get(), total);
  hasFolder = true;
  if (!ofBed.empty()) recorder.writer().fact("bed_warnings", fmt::format("{}", fmt::join(ofBed, "; ")));
  Checkpoints checkpoints(provenance, options);
  if (former) {
    checkpoints.begunAt(begin);
    fmt::print("resumed   at step {}, {:.6g} s\n", begin, simulation.time());
  }
  output::Summary summary;
  record(simulation, recorder, checkpoints, [&] {
    const Stopwatch driving;
    const double waitedBefore = comm.waited(), cpuBefore = cpuTime();
    if (!former) recorder.row(), recorder.frame(), checkpoints.remember(simulation, recorder.writer());
    drive(simulation, recorder, checkpoints, total);
    const double drove = driving.seconds(), waiting = (comm.waited() - waitedBefore) / drove;
    if (simulation.steps() == total && total < all)
      recorder.writer().fact("ended_by", fmt::format("--steps {}", total));
    const double cpu = 1e-6 * static_cast<double>(comm.sumOf(std::llround(1e6 * (cpuTime() - cpuBefore))));
    if (setup.output.picture) recorder.picture(setup.output.pictureWidth);

    summary.steps = simulation.steps(), summary.simulatedTime = simulation.time();
    summary.wallTime = whole.seconds();
    describeDrive(scene, simulation, recorder.drive().teeth(), recorder.writer(), summary);
    if (former) summary.figures["resumed_at_step"] = static_cast<double>(begin);
    summary.figures["wall_preparation_s"] = prepared, summary.figures["wall_settling_s"] = kept.settling;
    summary.figures["wall_cutting_s"] = kept.spheres ? kept.spheres->cutting() : 0;
    if (simulation.settled().steps > 0) {
      summary.figures["bed_highest_m"] = simulation.settled().highest;
      summary.figures["bed_mean_height_m"] = simulation.settled().meanHeight;
    }
    if (const auto& bed = simulation.ground().structure) {
      summary.figures["bed_porosity"] = bed->porosity;
      summary.figures["bed_order"] = bed->order;
      summary.figures["bed_thickness_in_mean_diameters"] = bed->thickness / bed->meanDiameter;
    }
    summary.figures["wall_steps_s"] = drove, summary.figures["cpu_steps_s"] = cpu;
    summary.figures["microseconds_a_step"] =
        1e6 * drove / static_cast<double>(std::max<std::int64_t>(1, simulation.steps() - begin));
    if (options.hash) summary.stateHash = simulation.stateHash();
    describeLedger(simulation);
    describeSqueezed(simulation, recorder, summary);
    fmt::print("wall      {:.1f} s preparation, {:.1f} s for {} steps of {:g} s ({:.0f} us a step), {:.1f} s of CPU "
               "time\n",
               prepared, drove, simulation.steps() - begin, setup.timeStep, summary.figures["microseconds_a_step"],
               cpu);
    if (simulation.mechanism()) describeSteps(*simulation.mechanism(), summary);
    describeSharing(simulation, waiting, summary);
    recorder.writer().finish(summary);
  });
  return summary;
}

} // namespace

output::Summary runScene(const scene::Scene& scene, const setup::Provenance& provenance, const RunRequest& options) {
  bool hasFolder = false;
  try {
    return runInFolder(scene, provenance, options, hasFolder);
  } catch (const base::SimulationError&) {
    // Its files are closed by now.
    if (hasFolder && scene.output.plots && options.comm().alone())
      leavePlots(options.folder, scene.vehicle.has_value());
    throw;
  }
}

} // namespace grouser::commands
