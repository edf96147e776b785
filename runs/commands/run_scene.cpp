// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/run_scene.hpp"

#include "base/counted.hpp"
#include "base/error.hpp"
#include "coupling/mechanism.hpp"
#include "coupling/simulation.hpp"
#include "runs/campaigns/forecast/machine_fit.hpp"
#include "runs/commands/bed_text.hpp"
#include "runs/commands/bed_warnings.hpp"
#include "runs/commands/drive_text.hpp"
#include "runs/commands/ledger_text.hpp"
#include "runs/commands/ranks_alike.hpp"
#include "runs/commands/run_summary.hpp"
#include "runs/output/mechanism_output.hpp"
#include "runs/output/run_status.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/soil.hpp"
#include "runs/session/branch.hpp"
#include "runs/session/failed_run.hpp"
#include "runs/session/final_figures.hpp"
#include "runs/session/preparation.hpp"
#include "runs/session/run_session.hpp"
#include "runs/setup/run_warnings.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/storage/scene_changes.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/print_stderr.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/stopwatch.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace grouser::commands {

namespace {

using support::Stopwatch;

/// CPU time of all threads of this process [s].
double cpuTime() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Prints the number of ranks, their subdomains, grains and ghosts.
void describeRanks(const coupling::Simulation& simulation) {
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

/// Prints the balance of the ranks' work. `waiting`: share of the time that this rank waited [-].
void describeSharing(const coupling::Simulation& simulation, double waiting, bool verbose, output::Summary& summary) {
  const auto& grains = simulation.ground().grains;
  const base::Comm& comm = simulation.comm();
  if (!grains || !grains->distribution()) return;
  const std::vector<double> waited = comm.gatherValue(waiting);
  const double least = *std::min_element(waited.begin(), waited.end()),
               most = *std::max_element(waited.begin(), waited.end());
  if (verbose)
    fmt::print("ranks     MPI wait time {:.1f} to {:.1f} % of the run; subdomains resized {} times\n", 100 * least,
               100 * most, grains->distribution()->rebalancings());
  summary.figures["rank_waiting_least"] = least;
  summary.figures["rank_waiting_most"] = most;
  summary.figures["rebalancings"] = static_cast<double>(grains->distribution()->rebalancings());
}

/// Prints the positions of objects placed on the settled bed.
void describePlaced(const coupling::Simulation& simulation) {
  const coupling::GroundSetup& ground = simulation.setup().ground;
  for (const coupling::SurfaceSetup& s : ground.surfaces)
    if (s.placedLater)
      fmt::print("placed    {} at ({:.6g}, {:.6g}, {:.6g}) m{}\n", s.name, s.start.position.x, s.start.position.y,
                 s.start.position.z, s.aboveBed ? fmt::format(", {:g} m above the bed", *s.aboveBed) : "");
  if (!ground.grains || ground.grains->onBed.empty()) return;
  std::size_t grains = 0;
  for (const coupling::PlacedGrains& p : ground.grains->onBed) grains += p.grains.size();
  fmt::print("placed    {} grain{} on the settled bed\n", grains, grains == 1 ? "" : "s");
}

void describeBuild(const coupling::Simulation& simulation, const setup::Provenance& provenance, const base::Exec& exec,
                   const session::Caches& kept) {
  fmt::print("device    {}\n", base::describe(exec));
  if (const auto& grains = simulation.ground().grains)
    fmt::print("grains    {}, {:.0f} bytes each\n", grainsText(*grains),
               static_cast<double>(grains->system().deviceBytes()) /
                   static_cast<double>(std::max<std::size_t>(1, grains->view().count)));
  describeRanks(simulation);
  for (const support::SoilUse& use : provenance.soils)
    fmt::print("soil      {}\n", scene::soilLine(use, simulation.ground().grains != nullptr));
  fmt::print("{}", bedText(simulation));
  describePlaced(simulation);
  if (kept.beds && !kept.beds->summary().empty()) fmt::print("bed       {}\n", kept.beds->summary());
  const std::string sets = kept.spheres ? kept.spheres->summary(simulation.comm()) : "";
  if (!sets.empty()) fmt::print("spheres   {}\n", sets);
  if (const coupling::VehicleRig* rig = simulation.vehicle()) {
    const auto isCut = [](const coupling::VehicleParts::SetFigures& f) { return f.spheres > 0; };
    const std::vector<coupling::VehicleParts::SetFigures>& figures = rig->parts().setFigures();
    fmt::print("vehicle   {:.0f} kg, {} bodies, running-gear contact by {}, {} spheres (for {} of {} meshes)\n",
               rig->assembly().mass, rig->assembly().model.bodies().size(),
               rig->parts().shapes() ? "shapes" : "samples", rig->parts().totalSpheres(),
               std::count_if(figures.begin(), figures.end(), isCut), figures.size());
    if (simulation.ground().grains && simulation.setup().vehicle->soilTouchesShoesOnly)
      fmt::print("soil      soil contact: track shoes only (vehicle.soil_contact)\n");
  }
  for (const std::string& note : bedNotes(simulation)) fmt::print("note      {}\n", note);
  if (const coupling::Mechanism* mechanism = simulation.mechanism())
    fmt::print("{}", output::mechanismSize(*mechanism));
  std::fflush(stdout);
}

/// Loads are unreliable if crushing removes more than this share of the impulse weight x time [-].
constexpr double kSuspect = 0.01;

/// Prints large overlaps and crushed grains, which do not end a run.
void describeSqueezed(const coupling::Simulation& simulation, session::Recorder& recorder,
                      const output::Summary& summary) {
  if (simulation.setup().crushes()) {
    std::string share;
    if (simulation.vehicle()) {
      const double of = summary.figures.at("crushing_cut_over_weight");
      share = fmt::format(", {:.3g} % of weight x time{}", 100 * of,
                          of > kSuspect ? ": the loads are unreliable; use larger or stronger grains" : "");
    }
    fmt::print("crushing  limited contact forces; impulse removed: {:.4g} N s{}\n",
               summary.figures.at("crushing_cut_impulse"), share);
    const coupling::CrushedGrains& gone = simulation.crushedGrains();
    if (gone.grains > 0)
      fmt::print(
          "crushed   {:g} grains removed: mass {:.4g} kg, energy {:.4g} J, momentum ({:.2g}, {:.2g}, {:.2g}) N s\n",
          gone.grains, gone.mass, gone.energy, gone.momentum.x, gone.momentum.y, gone.momentum.z);
  }
  fmt::print("{}", recorder.squeezed().text());
}

/// Prints the cost and accuracy of the complementarity solver.
void describeSolver(const coupling::Simulation& simulation, const output::Summary& summary) {
  if (!simulation.ground().grains || !simulation.ground().grains->system().impulses) return;
  const terrain::ImpulseTotals& all = simulation.ground().grains->system().impulses->totals();
  const terrain::ImpulseCost& cost = simulation.ground().grains->system().impulses->cost();
  const auto evaluations = static_cast<double>(std::max<std::int64_t>(1, cost.evaluations));
  const contact::ComplementarityOptions& asked = *simulation.ground().grains->model().complementarity;
  fmt::print(
      "solver    {:.1f} iterations per step, {:.3g} us per iteration{}, maximum residual {:.2g} m/s (limit "
      "{:.2g} m/s), maximum overlap at any output {:.2g} radii{}\n",
      summary.figures.at("solver_iterations_a_step"), 1e6 * cost.seconds / evaluations,
      cost.bytes > 0
          ? fmt::format(", {:.3g} kB sent per iteration (rank 0)", 1e-3 * static_cast<double>(cost.bytes) / evaluations)
          : "",
      all.worst, asked.residual, summary.figures.at("solver_max_overlap"),
      all.relaxed > 0 ? fmt::format(", {} solved by the convex relaxation", base::counted(all.relaxed, "step")) : "");
  if (all.raised > 0)
    fmt::print("note: in {} of {}, run.residual = {:.3g} m/s is below the rounding of the velocities, which was the "
               "tolerance instead; raise run.residual{}\n",
               base::counted(all.raised, "step"), all.steps, asked.residual,
               simulation.ground().grains->model().precision == terrain::Precision::single
                   ? ", or set run.precision = \"double\""
                   : "");
  if (all.missed > 0)
    fmt::print("WARNING: {} of {} exceed the tolerance run.residual; raise complementarity.iterations or run.residual, "
               "or use a smaller time_step\n",
               base::counted(all.missed, "step"), all.steps);
}

/// Prints and records the numbers and lengths of the steps of a mechanism with error control.
void describeSteps(const coupling::Mechanism& mechanism, bool verbose, output::Summary& summary) {
  if (!mechanism.controller()) return;
  const coupling::StepController::Record& r = mechanism.controller()->record();
  if (verbose)
    fmt::print("steps     mechanism: {} steps of {:.3g} to {:.3g} s, {} repeated\n", r.taken, r.smallest, r.largest,
               r.rejected);
  summary.figures["mechanism_steps"] = static_cast<double>(r.taken);
  summary.figures["mechanism_stretches_rejected"] = static_cast<double>(r.rejected);
  summary.figures["mechanism_step_smallest_s"] = r.smallest;
  summary.figures["mechanism_step_largest_s"] = r.largest;
}

/// Warns about bodies that have passed through the floor or the walls of a bed, which do not touch them.
void warnOfBodiesOutside(const coupling::Simulation& simulation) {
  const auto& ground = simulation.ground();
  const coupling::Mechanism* mechanism = simulation.mechanism();
  if (!mechanism || !ground.walls || !ground.rigid || !ground.grains) return;
  std::vector<std::string> outside;
  const std::vector<bool> touching = mechanism->touchingBodies();
  for (std::size_t body = 0; body < touching.size(); ++body) {
    if (!touching[body] || mechanism->model().bodies()[body].fixed) continue;
    const base::Vec3d p = mechanism->state().pose[body].position;
    const terrain::Rectangle& w = *ground.walls;
    if (p.z < ground.rigid->bounds().lowest || p.x < w.xMin || p.x > w.xMax || p.y < w.yMin || p.y > w.yMax)
      outside.push_back(mechanism->model().bodies()[body].name);
  }
  if (!outside.empty())
    fmt::print(
        "WARNING: {} {} outside the bed: its walls and floor have contact with grains only; enlarge terrain.size "
        "or terrain.depth\n",
        fmt::join(outside, ", "), outside.size() == 1 ? "ends" : "end");
}

/// Performs the steps up to the end of the run, with progress on stderr.
void drive(session::RunSession& run) {
  coupling::Simulation& simulation = run.simulation();
  const auto share = [&] { return static_cast<double>(simulation.steps()) / static_cast<double>(run.total()); };
  const coupling::StopSetup stop = simulation.vehicle() ? simulation.setup().vehicle->stop : coupling::StopSetup{};
  const bool mayStop = stop.distance || stop.edge || stop.immobile;
  support::Progress progress("running", simulation.comm().first(), share(),
                             mayStop ? support::Progress::End::limit : support::Progress::End::expected);
  while (run.continues()) {
    run.advance(run.total());
    if (progress.due())
      progress.update(share(), fmt::format("t {:.3f} of {:g} s", simulation.time(),
                                           static_cast<double>(run.total()) * simulation.timeStep()));
  }
  run.end();
  progress.finish(fmt::format("{} step{}", simulation.steps(), simulation.steps() == 1 ? "" : "s"));
}

/// Compares the final state of a replay with that of the recorded run. Throws SimulationError if they differ.
void describeReplay(const session::RecordedRun& recorded, const setup::Provenance& provenance,
                    const std::string& stateHash) {
  if (const auto changes = storage::changedKeys(recorded.scene, provenance.resolved); !changes.empty()) {
    fmt::print("replay    {} of {}: not compared, because the scene differs (key {})\n",
               base::counted(recorded.inputs.size(), "input"), recorded.folder.string(), changes.front().key);
    return;
  }
  if (recorded.stateHash.empty()) {
    fmt::print("WARNING: {} contains no state hash, because that run did not finish; nothing was compared\n",
               recorded.folder.string());
    fmt::print("replay    {} of {}: {} steps repeated\n", base::counted(recorded.inputs.size(), "input"),
               recorded.folder.string(), recorded.steps);
    return;
  }
  fmt::print("replay    {} of {}: {}\n", base::counted(recorded.inputs.size(), "input"), recorded.folder.string(),
             recorded.stateHash == stateHash ? "same state hash" : "DIFFERENT STATE HASH");
  if (recorded.stateHash != stateHash)
    throw base::SimulationError(fmt::format(
        "the replay ends with state hash {}, but {} has {}; use the program (commit) that wrote the recorded run",
        stateHash, recorded.folder.string(), recorded.stateHash));
}

void describeOrigin(const coupling::Simulation& simulation, const storage::Checkpoint& former, bool branch) {
  if (branch)
    fmt::print("branch    from {} ({:.6g} s)\n", former.branchedFrom->text(), simulation.time());
  else
    fmt::print("resumed   at step {}, {:.6g} s\n", simulation.steps(), simulation.time());
}

/// Records the step at which the run resumed or branched: the wall time covers later steps only.
void noteOrigin(const storage::Checkpoint& former, bool branch, output::Summary& summary) {
  if (!branch) summary.figures["resumed_at_step"] = static_cast<double>(former.state.steps);
  if (former.branchedFrom) summary.figures["branched_at_step"] = static_cast<double>(former.branchedFrom->step);
}

/// Records the option that ended the run. `cut`: the run ends before the scene's duration.
void noteEnd(session::RunSession& run, bool endsAtRest, bool cut) {
  if (endsAtRest)
    run.writer().fact("ended_by", output::kUntilRest);
  else if (cut && run.simulation().steps() == run.total())
    run.writer().fact("ended_by", fmt::format("--steps {}", run.total()));
}

/// Prints the notices to stderr.
void warnOf(const scene::Scene& scene, const coupling::Simulation& simulation) {
  for (const setup::Notice& notice : setup::noticesOf(scene, simulation))
    support::printStderr("{}: {}\n", notice.weight == setup::Notice::Weight::note ? "grouser: note" : "WARNING",
                         notice.text);
}

/// Throws base::InputError if --until rest has no vehicle to wait for.
void checkUntilRest(const scene::Scene& scene, const session::RunRequest& options) {
  if (options.untilRest && !scene.vehicle)
    throw base::InputError(fmt::format(
        "{}: --until rest requires a vehicle; add a section [vehicle], or remove the option", scene.file.string()));
}

/// Adds the final figures, and records warnings of a large time-integration error and of a sinkage beyond the table.
void noteResults(const scene::Scene& scene, session::RunSession& run, output::Summary& summary) {
  session::noteFigures(run, summary);
  if (const std::string warning = sinkageWarning(summary, scene.scm.value_or(scene::Scm{}).deepest); !warning.empty())
    run.writer().fact("soil_warning", warning), fmt::print("WARNING: {}\n", warning);
  if (const std::string warning = integrationWarning(summary); !warning.empty())
    run.writer().fact("energy_warning", warning);
}

/// `hasFolder`: set once the run owns its folder.
output::Summary runInFolder(const scene::Scene& scene, const setup::Provenance& provenance,
                            const session::RunRequest& options, bool& hasFolder) {
  const Stopwatch whole;
  const support::StopSignals signals;
  const base::Comm comm = options.comm();
  requireAlike(provenance, options.commandLine, comm);
  const base::Exec exec = support::chooseDevice(scene.run.device, scene.run.threads, options.ranks);
  forecast::requireFit(scene, exec, options.folder, options.force, !options.resume, options.ranks);
  support::FileLock folder; // lock of a resumed run; a new run creates and locks its folder later
  if (options.resume && !options.branch && comm.first()) output::claimFolder(folder, options.folder);
  const std::unique_ptr<storage::Checkpoint> former = session::formerRun(provenance, options);
  if (!former && comm.first()) warnOfTerrain(scene); // before a bed settles
  checkUntilRest(scene, options);
  const setup::RecordSetup record = setup::recordSetup(scene, provenance);
  coupling::SimulationSetup compiled = setup::simulationSetup(scene, comm.size(), setup::SizeChecks::passed);
  if (options.branch) session::branch(*former, provenance, compiled, options);
  session::Caches kept = session::cachesOf(scene.terrain && scene.terrain->cache, options);
  const std::unique_ptr<coupling::Simulation> made =
      session::makeSimulation(std::move(compiled), record, exec, former.get(), options, kept);
  coupling::Simulation& simulation = *made;
  const double timeStep = simulation.timeStep();
  const session::RecordedRun recorded = options.replay ? session::recordedRun(*options.replay) : session::RecordedRun{};
  const std::int64_t all = options.replay ? recorded.steps : std::llround(record.run.duration / timeStep),
                     begin = simulation.steps(), total = std::min(all, options.steps.value_or(all));
  if (begin > total || (options.branch && begin == total))
    throw base::InputError(
        fmt::format("{}: the checkpoint is at step {}, but this run ends at step {}; raise run.duration or --steps",
                    options.resume->string(), begin, total));
  const double prepared = whole.seconds();
  const std::vector<std::string> ofBed = bedWarnings(scene, simulation);
  if (comm.first())
    for (const std::string& warning : ofBed) support::printStderr("WARNING: {}\n", warning);
  describeBuild(simulation, provenance, exec, kept);
  if (!former && comm.first()) warnOf(scene, simulation);
  session::RunSession run(simulation, record, options, exec, former.get(), total);
  hasFolder = true;
  run.replay(recorded.inputs);
  if (!ofBed.empty()) run.writer().fact("bed_warnings", fmt::format("{}", fmt::join(ofBed, "; ")));
  if (former) describeOrigin(simulation, *former, options.branch);
  output::Summary summary;
  run.record([&] {
    const Stopwatch driving;
    const double waitedBefore = comm.waited(), cpuBefore = cpuTime();
    run.begin();
    drive(run);
    const double drove = driving.seconds(), waiting = (comm.waited() - waitedBefore) / drove;
    const bool endsAtRest = options.untilRest && run.isAtRest();
    noteEnd(run, endsAtRest, total < all);
    const double cpu = 1e-6 * static_cast<double>(comm.sumOf(std::llround(1e6 * (cpuTime() - cpuBefore))));
    if (record.output.picture) run.recorder().picture(record.output.pictureWidth);

    summary.steps = simulation.steps(), summary.simulatedTime = simulation.time();
    summary.wallTime = whole.seconds();
    noteResults(scene, run, summary);
    describeDrive(scene, simulation, run.recorder().drive().teeth(), summary, endsAtRest);
    if (former) noteOrigin(*former, options.branch, summary);
    summary.figures["wall_preparation_s"] = prepared, summary.figures["wall_settling_s"] = kept.settling;
    summary.figures["wall_cutting_s"] = kept.spheres ? kept.spheres->cutting() : 0;
    summary.figures["wall_steps_s"] = drove, summary.figures["cpu_steps_s"] = cpu;
    summary.figures["microseconds_a_step"] =
        1e6 * drove / static_cast<double>(std::max<std::int64_t>(1, simulation.steps() - begin));
    if (options.hash) summary.stateHash = simulation.stateHash();
    if (options.replay && total == all) describeReplay(recorded, provenance, summary.stateHash);
    describeSolver(simulation, summary);
    describeSqueezed(simulation, run.recorder(), summary);
    if (options.verbose) {
      describeLedger(simulation);
      fmt::print(
          "wall      {:.1f} s preparation, {:.1f} s for {} steps of {:g} s ({:.0f} us per step), {:.1f} s of CPU "
          "time\n",
          prepared, drove, simulation.steps() - begin, timeStep, summary.figures["microseconds_a_step"], cpu);
    }
    warnOfBodiesOutside(simulation);
    if (simulation.mechanism()) describeSteps(*simulation.mechanism(), options.verbose, summary);
    describeSharing(simulation, waiting, options.verbose, summary);
    run.writer().finish(summary);
  });
  return summary;
}

} // namespace

output::Summary runScene(const scene::Scene& scene, const setup::Provenance& provenance,
                         const session::RunRequest& options) {
  bool hasFolder = false;
  try {
    return runInFolder(scene, provenance, options, hasFolder);
  } catch (const support::Stopped& stopped) {
    if (!options.branch || stopped.left() == support::Stopped::Left::nothing) throw;
    throw StoppedBranch(stopped, options.folder / storage::kCheckpointName);
  } catch (const base::SimulationError&) {
    // The files of the run are closed at this point.
    if (hasFolder && scene.output.plots && options.comm().alone())
      session::leavePlots(options.folder, scene.vehicle.has_value());
    throw;
  }
}

} // namespace grouser::commands
