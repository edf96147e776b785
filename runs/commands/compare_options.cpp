// SPDX-License-Identifier: BSD-3-Clause
#include "base/counted.hpp"
#include "base/error.hpp"
#include "runs/campaigns/sweeps/compare.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/campaigns/sweeps/sweep_files.hpp"
#include "runs/commands/command_entry.hpp"
#include "runs/commands/process_options.hpp"
#include "runs/support/option_checks.hpp"
#include "runs/support/output_place.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grouser::commands {

namespace {

namespace fs = std::filesystem;

struct CompareCommand {
  std::string scene, device, folder;
  std::vector<std::string> grounds, contacts;
  std::vector<double> steps;
  std::optional<int> threads;
  sweeps::CompareOptions options;
};

/// Values of --steps, ascending.
std::vector<double> stepsOf(std::vector<double> steps, const sweeps::CompareOptions& options) {
  if (options.contacts.empty())
    throw base::InputError("--steps requires --contact: it multiplies the time step of each contact method");
  std::sort(steps.begin(), steps.end());
  const auto sameWord = [](double a, double b) { return fmt::format("{:g}", a) == fmt::format("{:g}", b); };
  if (const auto same = std::adjacent_find(steps.begin(), steps.end(), sameWord); same != steps.end())
    throw base::InputError(
        fmt::format("--steps: {} and {} are the same value to six digits; remove one", same[0], same[1]));
  return steps;
}

void compareCommand(CompareCommand command) {
  sweeps::CompareOptions& options = command.options;
  if (command.grounds.empty() == command.contacts.empty())
    throw base::InputError(
        "compare requires either --grounds or --contact with two or more values, separated by commas");
  if (!command.grounds.empty()) options.grounds = sweeps::groundsOf(command.grounds);
  if (!command.contacts.empty()) options.contacts = sweeps::contactsOf(command.contacts);
  if (!command.steps.empty()) options.steps = stepsOf(command.steps, options);
  addDeviceOverrides(options.fixed, command.device, command.threads);
  sweeps::checkGivenOnce(options.fixed);
  for (const std::string& set : options.fixed)
    for (const auto& [key, option] :
         {std::pair{"terrain.kind", "--grounds"}, {"run.contact", "--contact"}, {"run.seed", "--seeds"}})
      if (sweeps::keyOf(set) == key && (std::string(option) != "--contact" || !command.contacts.empty()))
        throw base::InputError(fmt::format("--set {}: {} sets this key; remove it from --set", set, option));
  const fs::path file = command.scene;
  options.sweep.program = fs::read_symlink("/proc/self/exe");
  options.sweep.folder =
      command.folder.empty() ? fs::path("out") / (file.stem().string() + "_compare") : fs::path(command.folder);
  support::requireFolder(options.sweep.folder);
  if (const int failed = sweeps::runCompare(file, options))
    throw base::SimulationError(fmt::format("{} failed; see {}", base::counted(failed, "run"),
                                            (options.sweep.folder / sweeps::kSummaryFile).string()));
}

} // namespace

void addCompare(CLI::App& app, const Invocation& invocation) {
  const auto command = std::make_shared<CompareCommand>();
  CompareCommand& c = *command;
  c.options.words = invocation.words;
  CLI::App* compare = app.add_subcommand("compare", "Compare runs of one scene on several kinds of ground, or with "
                                                    "several contact methods: figures, differences, cost");
  compare->add_option("scene", c.scene, "scene file")->required();
  compare
      ->add_option(
          "--grounds", c.grounds,
          fmt::format("two or more of {}, separated by commas", fmt::join(base::wordsOf<scene::TerrainKind>(), ", ")))
      ->delimiter(',');
  compare
      ->add_option("--contact", c.contacts,
                   fmt::format("two or more of {}, separated by commas; instead of --grounds",
                               fmt::join(base::wordsOf<scene::ContactMethod>(), ", ")))
      ->delimiter(',');
  compare
      ->add_option(
          "--steps", c.steps,
          "multiples of the time step of each contact method, separated by commas, e.g. 0.25,0.5,1: error over "
          "run time, with the smallest step of the first method as reference; requires --contact")
      ->check(support::positive("a number"))
      ->delimiter(',');
  compare
      ->add_option("--seeds", c.options.seeds,
                   "number of seeds on granular ground, one run each; other kinds of ground need only one run")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  compare
      ->add_option("--set", c.options.fixed,
                   std::string(kSetHelp) + "; keys of one kind of ground affect only that ground")
      ->allow_extra_args(false);
  compare
      ->add_option("--bar", c.options.percent,
                   "tolerance within which means count as equal, in percent of the larger mean (10 or 10%); default: 5")
      ->transform(support::percentSign())
      ->check(support::positive("a percentage"));
  addProcessOptions(
      *compare, {c.options.sweep.jobs, c.options.sweep.seconds, c.options.sweep.force, c.folder, c.device, c.threads},
      "output folder; default: out/NAME_compare");
  compare->callback([command] { compareCommand(*command); });
}

} // namespace grouser::commands
