// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/command_entry.hpp"

#include "runs/commands/commands.hpp"
#include "runs/commands/process_options.hpp"
#include "runs/support/option_checks.hpp"

#include <memory>

namespace grouser::commands {

void addRun(CLI::App& app, const Invocation& invocation) {
  const auto command = std::make_shared<RunCommand>();
  RunCommand& c = *command;
  c.ranks = &invocation.ranks, c.commandLine = invocation.words;
  CLI::App* run = app.add_subcommand("run", "Settle the bed, lower the vehicle, drive, and write the results");
  CLI::Option* scene = run->add_option("scene", c.scene, "scene file; `grouser fields` lists its keys");
  run->add_option("--set", c.overrides, kSetHelp)->allow_extra_args(false);
  run->add_option("--device", c.device, "auto, cpu or cuda; default: as the scene says");
  run->add_option("--threads", c.threads, "CPU threads, 0 for all; the answer does not depend on it")
      ->check(support::wholeNumber(0, 1024));
  support::addOut(*run, c.folder, "folder of the results; default: out/NAME of the scene");
  run->add_option("--steps", c.steps, "stop after so many steps of the drive")->check(support::wholeNumber(1));
  run->add_flag("--force", c.force, "overwrite the results in that folder");
  CLI::Option* resume =
      run->add_option("--resume", c.checkpoint,
                      "go on from this checkpoint as if the run had not been stopped; default: that of its folder. "
                      "With other keys of the drive or the hitch, or another folder, a branch that leaves that run as "
                      "it is; default of its --out: out/NAME_branch")
          ->expected(0, 1)
          ->type_name("[FILE]");
  run->add_option(
         "--replay", c.replay,
         "repeat the run of this folder, with all that was set from outside while it went; compares the hashes")
      ->excludes(scene)
      ->excludes(resume);
  run->add_option("--until", c.until,
                  "rest: stop, with a checkpoint to branch from, where the vehicle has been lowered and would begin to "
                  "drive")
      ->check(CLI::IsMember({"rest"}));
  run->add_flag("!--no-cache", c.cache, "settle the bed and cut the parts anew, and keep neither");
  run->add_flag("--hash", c.hash, "print the hash of the final state as the last line");
  run->callback([command, resume] {
    if (command->scene.empty() && command->replay.empty())
      throw CLI::RequiredError("run: a scene file, or --replay FOLDER");
    command->resume = resume->count() > 0;
    runCommand(*command);
  });
}

void addSweep(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<SweepCommand>();
  SweepCommand& c = *command;
  CLI::App* sweep = app.add_subcommand("sweep", "Many runs of a scene over lists of values, with a summary");
  sweep->add_option("scene", c.scene, "scene file")->required();
  sweep
      ->add_option(
          "--set", c.lists.sets,
          "a key and its values, e.g. driver.sprocket_speed=0.5,1,2; may be repeated: all combinations are run")
      ->allow_extra_args(false);
  sweep
      ->add_option_function<std::string>(
          "--ground", [&c](const std::string& word) { c.ground = base::valueOf<scene::TerrainKind>(word); },
          "another kind of ground for the scene: rigid, granular or scm; default: as the scene says")
      ->check(CLI::IsMember(base::wordsOf<scene::TerrainKind>()));
  sweep
      ->add_option("--case", c.lists.cases,
                   "a name, and keys that change together: 'slow: driver.sprocket_speed=0.5, run.duration=16'; a name "
                   "alone is the scene as it is; may be repeated, the first is the one to compare with")
      ->allow_extra_args(false);
  sweep
      ->add_option("--seeds", c.lists.seeds,
                   "each combination with run.seed 1 to so many: means with 95 % intervals, and differences")
      ->check(support::wholeNumber(1, 1000));
  addProcessOptions(
      *sweep, {c.jobs, c.seconds, c.force, c.folder, c.device, c.threads},
      "folder for the runs' folders and summary.csv; default: out/NAME_sweep, with --ground out/NAME_sweep_GROUND");
  CLI::Option* from =
      sweep
          ->add_option("--from-checkpoint", c.checkpoint,
                       "all runs branch from this checkpoint of a vehicle at rest (run --until rest); without FILE the "
                       "vehicle is lowered once, and once a seed, in the folder settled")
          ->expected(0, 1)
          ->type_name("[FILE]");
  sweep->callback([command, from] {
    command->branches = from->count() > 0;
    sweepCommand(*command);
  });
}

void addPlan(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<PlanCommand>();
  PlanCommand& p = *command;
  CLI::App* plan = app.add_subcommand(
      "plan", "Prints active features, size, time step and memory of a scene, and predicts its run time");
  plan->add_option("scene", p.scene, "scene file")->required();
  plan->add_option("--set", p.overrides, kSetHelp)->allow_extra_args(false);
  plan->add_option("--ranks", p.ranks, "also how so many ranks (mpirun -np) would share the grains")
      ->check(support::wholeNumber(1, 100'000));
  plan->add_option("--device", p.device, "auto, cpu or cuda; default: as the scene says");
  plan->add_option("--threads", p.threads, "CPU threads, 0 for all")->check(support::wholeNumber(0, 1024));
  support::addOut(*plan, p.folder, "folder that results would go to; default: out/NAME of the scene");
  CLI::Option* without = plan->add_flag("!--no-probe", p.forecast, "skip the run-time prediction");
  plan->add_flag("--probe", p.probe, "measure every part (up to minutes); later plans reuse the results")
      ->excludes(without);
  plan->add_option("--json", p.json, "also write the predicted time of each part to this file")
      ->excludes(without)
      ->check(support::writableFile("--json"));
  plan->add_flag("!--no-cache", p.cache, "for a run that settles the bed and cuts the parts anew");
  plan->callback([command] { planCommand(*command); });
}

} // namespace grouser::commands
