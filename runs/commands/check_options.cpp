// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "runs/campaigns/sweeps/check.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/commands/command_entry.hpp"
#include "runs/commands/process_options.hpp"
#include "runs/support/option_checks.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grouser::commands {

namespace {

struct CheckCommand {
  std::string scene, device, folder;
  std::vector<std::string> axes;
  std::optional<int> threads;
  sweeps::CheckOptions options;
};

void checkCommand(CheckCommand command) {
  sweeps::CheckOptions& options = command.options;
  addDeviceOverrides(options.fixed, command.device, command.threads);
  sweeps::checkGivenOnce(options.fixed);
  for (const std::string& set : options.fixed)
    if (sweeps::keyOf(set) == "run.seed")
      throw base::InputError(
          "--set run.seed: a check runs several seeds, starting with run.seed of the scene file; change it there");
  for (const std::string& word : command.axes) options.axes.push_back(sweeps::checkAxisOf(word));
  const std::filesystem::path file = command.scene;
  options.sweep.program = std::filesystem::read_symlink("/proc/self/exe");
  options.sweep.folder = command.folder.empty() ? std::filesystem::path("out") / (file.stem().string() + "_check")
                                                : std::filesystem::path(command.folder);
  sweeps::runCheck(file, options);
}

} // namespace

void addCheck(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<CheckCommand>();
  CheckCommand& c = *command;
  CLI::App* check = app.add_subcommand(
      "check",
      "Compute error bars of a scene's results from runs with other time steps, seeds, domain sizes and grain sizes");
  check->add_option("scene", c.scene, "scene file")->required();
  check->add_option("--set", c.options.fixed, kSetHelp)->allow_extra_args(false);
  check
      ->add_option(
          "--seeds", c.options.seeds,
          "number of seeds per case (consecutive, from run.seed); with --budget or --of, the maximum number; a "
          "scene that does not depend on the seed runs once per case; default: 8, or 24 with --of")
      ->check(support::wholeNumber(2, 1000));
  check
      ->add_option("--bar", c.options.percent,
                   "tolerance within which values count as equal, and target error bar for --of, in percent of the "
                   "value (10 or 10%); default: 5")
      ->transform(support::percentSign())
      ->check(support::positive("a percentage"));
  check
      ->add_option("--of", c.options.figures,
                   "reduce the error bars of these figures to --bar in the shortest run time: sinkage, torque, "
                   "speed, slip, tension, motion_resistance, or any figure listed in check.json")
      ->delimiter(',');
  check
      ->add_option(
          "--axes", c.axes,
          "parameters to vary: step, skin, depth, width, floor, grain_size, spheres, precision, node_spacing (of "
          "deformable soil); default: all")
      ->delimiter(',');
  check
      ->add_option("--draws", c.options.draws,
                   "number of random samples of the constants of deformable soil, for the parameter error of each "
                   "figure; default: 0")
      ->check(support::wholeNumber(0, 1000));
  check->add_option("--budget", c.options.budget,
                    "limit on the total wall time, e.g. 90s, 20min or 1.5h; the duration of the first run is used to "
                    "estimate which runs would exceed the limit; these are skipped and listed");
  addProcessOptions(
      *check, {c.options.sweep.jobs, c.options.sweep.seconds, c.options.sweep.force, c.folder, c.device, c.threads},
      "output folder; default: out/NAME_check");
  check->callback([command] { checkCommand(*command); });
}

} // namespace grouser::commands
