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
      throw base::InputError("--set run.seed: a check runs several seeds, starting with that of the scene; change "
                             "run.seed in the scene file");
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
  CLI::App* check = app.add_subcommand("check", "Error bars of a scene's figures by step, seed, extent and grain size");
  check->add_option("scene", c.scene, "scene file")->required();
  check->add_option("--set", c.options.fixed, kSetHelp)->allow_extra_args(false);
  check
      ->add_option("--seeds", c.options.seeds,
                   "number of seeds of each case, starting with run.seed, where the seed has an effect; a maximum with "
                   "--budget or --of; default: 8, with --of 24")
      ->check(support::wholeNumber(2, 1000));
  check
      ->add_option(
          "--bar", c.options.percent,
          "tolerance of the verdict equal, and target of --of, in percent of a figure's value (10 or 10%); default: 5")
      ->transform(support::percentSign())
      ->check(support::positive("a share in percent"));
  check
      ->add_option(
          "--of", c.options.figures,
          "figures whose error bars are reduced to --bar, with the runs that do so at the least cost: sinkage, "
          "torque, speed, slip, tension, motion_resistance, or any figure of check.json")
      ->delimiter(',');
  check
      ->add_option(
          "--axes", c.axes,
          "parameters to vary: step, skin, depth, width, floor, grain_size, spheres, precision, node_spacing (of "
          "deformable soil); default: all")
      ->delimiter(',');
  check
      ->add_option("--draws", c.options.draws,
                   "samples of the constants of deformable soil, for the parameter error of each figure; default: 0")
      ->check(support::wholeNumber(0, 1000));
  check->add_option("--budget", c.options.budget,
                    "limit of the total wall time, e.g. 90s, 20min or 1.5h; the first run decides which runs fit, the "
                    "others are listed");
  addProcessOptions(
      *check, {c.options.sweep.jobs, c.options.sweep.seconds, c.options.sweep.force, c.folder, c.device, c.threads},
      "folder for the runs' folders and the results; default: out/NAME_check");
  check->callback([command] { checkCommand(*command); });
}

} // namespace grouser::commands
