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
  CLI::App* run =
      app.add_subcommand("run", "Run a scene: settle the bed, lower the vehicle, drive, and write the results");
  CLI::Option* scene = run->add_option("scene", c.scene, "scene file; `grouser fields` lists its keys");
  run->add_option("--set", c.overrides, kSetHelp)->allow_extra_args(false);
  run->add_option("--device", c.device, "auto, cpu or cuda; default: run.device of the scene");
  run->add_option("--threads", c.threads,
                  "number of CPU threads; 0: all available cores, at most OMP_NUM_THREADS; default: run.threads of the "
                  "scene; the results do not depend "
                  "on it")
      ->check(support::wholeNumber(0, 1024));
  support::addOut(*run, c.folder, "results folder; default: out/NAME, where NAME is the scene name");
  run->add_option("--steps", c.steps, "stop at this time step, counted after settling")->check(support::wholeNumber(1));
  run->add_flag("--force", c.force, "overwrite existing results in the output folder");
  CLI::Option* resume =
      run->add_option(
             "--resume", c.checkpoint,
             "resume from this checkpoint, with results bitwise identical to those of an uninterrupted run; default: "
             "the checkpoint in the results folder. With a different --out, or different keys of driver or hitch, "
             "start a branch instead: the original run remains unchanged (default of --out: out/NAME_branch)")
          ->expected(0, 1)
          ->type_name("[FILE]");
  run->add_option("--replay", c.replay,
                  "repeat the run in this folder with its recorded inputs and compare the state hashes")
      ->excludes(scene)
      ->excludes(resume);
  run->add_option("--until", c.until, "rest: stop before the drive starts, and write a checkpoint for branches")
      ->check(CLI::IsMember({"rest"}));
  run->add_flag("!--no-cache", c.cache, "disable the cache of settled beds and sphere sets");
  run->add_flag("--verbose", c.verbose, "also print energy balance, momentum, run time and all files written");
  run->add_option("--beside", c.beside, "print the figures of the run in this folder in a second column for comparison")
      ->check(CLI::ExistingDirectory);
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
  CLI::App* sweep = app.add_subcommand(
      "sweep", "Run a scene for all combinations of values of several keys, and summarise the results");
  sweep->add_option("scene", c.scene, "scene file")->required();
  sweep
      ->add_option(
          "--set", c.lists.sets,
          "key and its values, e.g. driver.sprocket_speed=0.5,1,2; repeat it to run all combinations of several keys")
      ->allow_extra_args(false);
  sweep
      ->add_option_function<std::string>(
          "--ground", [&c](const std::string& word) { c.ground = base::valueOf<scene::TerrainKind>(word); },
          "kind of ground that replaces terrain.kind: rigid, granular or scm; default: that of the scene")
      ->check(CLI::IsMember(base::wordsOf<scene::TerrainKind>()));
  sweep
      ->add_option(
          "--case", c.lists.cases,
          "name of a case and the keys that it changes, e.g. 'slow: driver.sprocket_speed=0.5, run.duration=16'; a "
          "name without keys means the unchanged scene; may be repeated; the first case is the reference")
      ->allow_extra_args(false);
  sweep
      ->add_option(
          "--seeds", c.lists.seeds,
          "number of seeds per combination (run.seed = 1, 2, ...), for means and differences with 95 % intervals")
      ->check(support::wholeNumber(1, 1000));
  addProcessOptions(
      *sweep, {c.jobs, c.seconds, c.force, c.folder, c.device, c.threads},
      "output folder for the runs and summary.csv; default: out/NAME_sweep, with --ground out/NAME_sweep_GROUND");
  CLI::Option* from =
      sweep
          ->add_option("--from-checkpoint", c.checkpoint,
                       "start all runs as branches from this checkpoint of a vehicle at rest (run --until rest); "
                       "without FILE, first settle the vehicle once per seed, in the subfolder settled")
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
      "plan", "Print active features, size, time step and memory of a scene, and predict its run time");
  plan->add_option("scene", p.scene, "scene file")->required();
  plan->add_option("--set", p.overrides, kSetHelp)->allow_extra_args(false);
  plan->add_option("--ranks", p.ranks, "also print how the grains would be distributed over this number of MPI ranks")
      ->check(support::wholeNumber(1, 100'000));
  plan->add_option("--device", p.device, "auto, cpu or cuda; default: run.device of the scene");
  plan->add_option(
          "--threads", p.threads,
          "number of CPU threads; 0: all available cores, at most OMP_NUM_THREADS; default: run.threads of the scene")
      ->check(support::wholeNumber(0, 1024));
  support::addOut(*plan, p.folder,
                  "results folder of the planned run; default: out/NAME, where NAME is the scene name");
  CLI::Option* without = plan->add_flag("!--no-probe", p.forecast, "skip the run-time prediction");
  plan->add_flag("--probe", p.probe, "measure the time of each part (up to minutes) and store it for later plans")
      ->excludes(without);
  plan->add_option("--json", p.json, "also write the predicted time of each part to this file")
      ->excludes(without)
      ->check(support::writableFile("--json"));
  plan->add_flag("!--no-cache", p.cache, "assume a run without the cache of settled beds and sphere sets");
  plan->callback([command] { planCommand(*command); });
}

} // namespace grouser::commands
