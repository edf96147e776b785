// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/commands.hpp"

#include "base/counted.hpp"
#include "base/cpu_threads.hpp"
#include "base/error.hpp"
#include "base/input_file.hpp"
#include "runs/campaigns/forecast/counted_grains.hpp"
#include "runs/campaigns/forecast/forecast.hpp"
#include "runs/campaigns/forecast/machine_fit.hpp"
#include "runs/campaigns/sweeps/grounds.hpp"
#include "runs/campaigns/sweeps/kept_checks.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/campaigns/sweeps/run_notices.hpp"
#include "runs/campaigns/sweeps/scene_check.hpp"
#include "runs/campaigns/sweeps/sweep.hpp"
#include "runs/campaigns/sweeps/sweep_files.hpp"
#include "runs/commands/bed_warnings.hpp"
#include "runs/commands/plan.hpp"
#include "runs/commands/process_options.hpp"
#include "runs/commands/run_scene.hpp"
#include "runs/commands/run_summary.hpp"
#include "runs/output/manifest.hpp"
#include "runs/output/output.hpp"
#include "runs/output/plots.hpp"
#include "runs/output/sinkage.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/session/output_times.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/storage/scene_changes.hpp"
#include "runs/storage/sphere_cache.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/output_place.hpp"
#include "runs/support/print_stderr.hpp"
#include "runs/support/shell_word.hpp"
#include "runs/support/text_file.hpp"
#include "spheredecomp/decompose.hpp"
#include "spheredecomp/mesh.hpp"
#include "spheredecomp/quality.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <optional>

namespace grouser::commands {

namespace fs = std::filesystem;

namespace {

void drawAndName(const fs::path& results, const fs::path& folder, const std::vector<std::string>& names,
                 bool verbose = true) {
  std::string warning;
  for (const fs::path& plot : output::drawPlots(results, folder, names, warning))
    if (verbose) fmt::print("plot      {}\n", plot.string());
  if (!warning.empty()) support::printStderr("WARNING: {}\n", warning);
}

/// Results folder: `given` on the command line, or the folder of the scene.
fs::path folderOf(const scene::Scene& scene, const std::string& given) {
  return !given.empty()                 ? fs::path(given)
         : !scene.output.folder.empty() ? fs::path(scene.output.folder)
                                        : fs::path("out") / scene.name();
}

void nameIfThere(const char* what, const fs::path& file) {
  if (fs::exists(file)) fmt::print("{:<9} {}\n", what, file.string());
}

/// A resumed run writes to the folder of its checkpoint, a branch to a different folder.
void chooseCheckpoint(const RunCommand& command, const setup::Provenance& provenance, session::RunRequest& options) {
  std::error_code error;
  if (!command.checkpoint.empty())
    if (const std::string fault = base::inputFault(command.checkpoint); !fault.empty())
      throw base::InputError(fmt::format("--resume {}{}; specify the checkpoint.h5 of a run, or omit the file name to "
                                         "use the checkpoint in the results folder",
                                         command.checkpoint, fault));
  options.resume =
      command.checkpoint.empty() ? options.folder / storage::kCheckpointName : fs::path(command.checkpoint);
  const fs::path home = fs::absolute(*options.resume).lexically_normal().parent_path();
  const bool isNamed = !command.folder.empty(), isElsewhere = isNamed && !fs::equivalent(options.folder, home, error);
  const storage::Checkpoint origin = storage::readOrigin(*options.resume, options.comm());
  options.branch = isElsewhere || storage::checkSameScene(origin, *options.resume, provenance).any();
  if (!options.branch) {
    if (!command.checkpoint.empty()) options.folder = home;
    return;
  }
  if (!isNamed) options.folder += "_branch";
  if (fs::equivalent(options.folder, home, error))
    throw base::InputError(
        fmt::format("{}: contains the original run; its [driver] or [hitch] differs from this scene; to start a "
                    "branch, set another folder with --out, and the checkpoint with --resume {}",
                    options.folder.string(), options.resume->string()));
}

/// Wall time of preparation and steps [s]; excludes the rendering of pictures.
double secondsOf(const output::Summary& summary) {
  double seconds = 0;
  for (const char* part : {"wall_preparation_s", "wall_steps_s"})
    if (const auto at = summary.figures.find(part); at != summary.figures.end()) seconds += at->second;
  return seconds;
}

} // namespace

void runCommand(const RunCommand& command) {
  std::vector<std::string> overrides = command.overrides;
  addDeviceOverrides(overrides, command.device, command.threads);
  sweeps::checkGivenOnce(overrides);
  const fs::path replayed = fs::path(command.replay).lexically_normal();
  const scene::Scene scene =
      setup::loadScene(command.replay.empty() ? fs::path(command.scene) : replayed / "scene.toml", overrides);
  if (!command.ranks || command.ranks->comm().first()) scene::printNotes(scene);

  session::RunRequest options;
  options.folder = folderOf(scene, command.folder);
  if (!command.replay.empty()) {
    options.replay = replayed;
    if (command.folder.empty())
      options.folder = (replayed.has_filename() ? replayed : replayed.parent_path()).string() + "_replay";
  }
  options.force = command.force, options.hash = command.hash || options.replay, options.steps = command.steps;
  options.cache = command.cache;
  options.commandLine = command.commandLine;
  options.switches = switchesText(scene);
  options.ranks = command.ranks, options.verbose = command.verbose;
  options.untilRest = !command.until.empty();
  if (!command.resume && options.comm().first()) output::checkOutputFolder(options.folder, options.force);
  const setup::Provenance provenance = setup::provenanceOf(scene);
  if (command.resume) chooseCheckpoint(command, provenance, options);
  if (options.branch && options.comm().first()) output::checkOutputFolder(options.folder, options.force);
  const output::Summary summary = runScene(scene, provenance, options);
  if (!options.comm().first()) return;

  const fs::path results = options.folder / "results.h5";
  if (scene.vehicle) output::writeSinkageCsv(results, options.folder);
  if (scene.output.plots) drawAndName(results, options.folder, output::kAllPlots, command.verbose);
  output::listFiles(options.folder);
  if (command.verbose)
    for (const char* file : {"timeseries.csv", "grains.csv", "sinkage.csv", "picture.png", "frames.xdmf", "results.h5"})
      nameIfThere("file", options.folder / file);
  if (scene.vehicle && !options.untilRest)
    fmt::print("{}", driveFiguresText(options.folder, command.beside, summary.incomplete));
  fmt::print("{}results   {} (HTML report: grouser report {})\n", energyText(summary), options.folder.string(),
             support::shellWord(options.folder.string()));
  if (!command.steps && !options.untilRest)
    fmt::print("{}",
               sweeps::checkNote(scene, provenance.inputs, secondsOf(summary), command.verbose || !scene.vehicle));
  if (command.hash) fmt::print("state-hash {} step {}\n", summary.stateHash, summary.steps);
}

void sweepCommand(const SweepCommand& command) {
  const std::string suffix = command.ground ? fmt::format("_sweep_{}", base::wordOf(*command.ground)) : "_sweep";
  const fs::path folder = command.folder.empty() ? fs::path("out") / (fs::path(command.scene).stem().string() + suffix)
                                                 : fs::path(command.folder);
  support::requireFolder(folder);
  std::vector<std::string> fixed;
  addDeviceOverrides(fixed, command.device, command.threads);
  if (command.ground) fixed = sweeps::groundOverrides(command.scene, command.lists, fixed, *command.ground);
  const sweeps::SweepPlan plan = sweeps::planSweep(command.scene, command.lists, fixed);
  sweeps::printNotesOf(plan);
  sweeps::SweepOptions options;
  options.program = fs::read_symlink("/proc/self/exe");
  options.folder = folder;
  options.jobs = command.jobs, options.seconds = command.seconds, options.force = command.force;
  if (command.branches) options.from = command.checkpoint;
  if (const int failed = sweeps::runSweep(plan, options))
    throw base::SimulationError(fmt::format("{} of {} failed; see the messages in {}", failed,
                                            base::counted(plan.runs.size(), "run"),
                                            (options.folder / sweeps::kSummaryFile).string()));
}

void hashCommand(const HashCommand& command) {
  const coupling::SimulationState state = storage::readCheckpoint(command.checkpoint).state;
  fmt::print("state-hash {} step {}\n", state.hash(), state.steps);
}

void sinkageCommand(const SinkageCommand& command) {
  const fs::path results = command.results;
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(results, ignored)) && !fs::is_directory(results, ignored))
    base::requireInput(results, "specify the results.h5 of a run");
  const fs::path folder = command.folder.empty() ? fs::absolute(results).parent_path() : fs::path(command.folder);
  support::requireFolder(folder);
  if (command.shoes.empty()) {
    if (!command.control.empty())
      throw base::InputError("--control requires --shoes; set the shoes to compare, e.g. --shoes 10-13,20");
    if (!command.track.empty())
      throw base::InputError("--track requires --shoes; set shoes of that track, e.g. --shoes 10-13,20");
    fmt::print("sinkage   {}\n", output::writeSinkageCsv(results, folder).string());
    return drawAndName(results, folder, {"sinkage"});
  }
  const std::vector<int> shoes = output::shoesNamed(command.shoes);
  if (!command.control.empty()) output::requireShoes(command.control, shoes, command.track);
  fmt::print("sinkage   {}\n", output::writeSinkageCsv(results, folder, shoes, command.track).string());
  std::vector<fs::path> inputs{results};
  if (!command.control.empty()) inputs.push_back(fs::absolute(command.control));
  inputs.emplace_back(command.track + (command.track.empty() ? "" : ":") + fmt::format("{}", fmt::join(shoes, ",")));
  output::drawPicture("single_shoes.py", inputs, folder / "sinkage_shoes.png");
}

void planCommand(const PlanCommand& command) {
  std::vector<std::string> overrides = command.overrides;
  addDeviceOverrides(overrides, command.device, command.threads);
  sweeps::checkGivenOnce(overrides);
  const scene::Scene scene = setup::loadScene(command.scene, overrides);
  scene::printNotes(scene);
  const base::Exec exec = support::chooseDevice(scene.run.device, scene.run.threads, nullptr);
  const fs::path folder = folderOf(scene, command.folder);
  // If the scene exceeds the resources of this machine, the plan is printed, but nothing is laid or run.
  std::string misfit;
  try {
    forecast::requireFit(scene, exec, folder, true, true, nullptr);
  } catch (const base::InputError& error) {
    misfit = error.what();
  }
  try {
    sweeps::checkScene(scene, false);
  } catch (const base::InputError&) {
    // If the scene exceeds the resources of this machine, this error precedes all others.
    if (!misfit.empty()) throw base::InputError(misfit);
    throw;
  }
  for (const std::string& warning : plannedBedWarnings(scene)) support::printStderr("WARNING: {}\n", warning);
  const forecast::CountedGrains counted =
      forecast::countGrains(scene, setup::chooseTimeStep(scene), misfit.empty() ? forecast::kMaxLaid : 0);
  fmt::print("{}", planText(scene, &counted));
  if (command.ranks > 1) fmt::print("{}", sharePlan(scene, command.ranks));
  std::fflush(stdout);
  if (!misfit.empty()) throw base::InputError(misfit);
  if (!command.forecast) return;
  const auto stage = [](const char* what) { support::printStderr("plan: {}\n", what); };
  const forecast::Forecast predicted =
      forecast::forecastOf(scene, counted, {folder, 1, command.cache, command.probe, stage});
  fmt::print("{}", forecast::forecastText(predicted));
  if (!command.json.empty()) support::writeTextFile(command.json, forecast::forecastJson(predicted), "--json");
}

void spheresCommand(const SpheresCommand& command) {
  base::ompNumThreads(); // throws for an invalid value
  spheredecomp::DecompositionOptions options;
  options.radius = command.radius, options.targetCount = command.count;
  std::error_code error;
  if (!command.csv.empty() && !command.force && fs::exists(command.csv, error))
    throw base::InputError(fmt::format(
        "--csv {}: the file already exists; choose another name, or overwrite it with --force", command.csv));
  const base::TriangleMesh mesh = spheredecomp::importMesh(command.mesh);
  std::optional<storage::SphereCache> kept = storage::SphereCache::ofUser();
  const base::SphereSet set =
      coupling::cutParts({{&mesh, fs::path(command.mesh).filename().string(), options}}, kept ? &*kept : nullptr, {})
          .front();
  fmt::print("{}", spheredecomp::report(set, spheredecomp::measure(mesh, set)));
  if (command.csv.empty()) return;
  std::string text = "x [m],y [m],z [m],radius [m]\n";
  for (const base::SetSphere& s : set.spheres)
    text += fmt::format("{},{},{},{}\n", s.centre.x, s.centre.y, s.centre.z, s.radius);
  support::writeTextFile(command.csv, text, "--csv");
  fmt::print("spheres   {}\n", command.csv);
}

} // namespace grouser::commands
