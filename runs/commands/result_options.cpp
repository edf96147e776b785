// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/command_entry.hpp"

#include "runs/commands/commands.hpp"
#include "runs/support/option_checks.hpp"

#include <memory>

namespace grouser::commands {

void addHash(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<HashCommand>();
  HashCommand& c = *command;
  CLI::App* hash =
      app.add_subcommand("hash", "Print the hash of the state in a checkpoint, in the format of run --hash");
  hash->add_option("checkpoint", c.checkpoint, "checkpoint.h5 of a run, or the run's folder")
      ->required()
      ->transform(support::orItsFolder("checkpoint.h5"));
  hash->callback([command] { hashCommand(*command); });
}

void addSinkage(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<SinkageCommand>();
  SinkageCommand& s = *command;
  CLI::App* sinkage =
      app.add_subcommand("sinkage", "Write the sinkage of each track shoe over time [m] as CSV and as a plot");
  sinkage->add_option("results", s.results, "results.h5 of a run, or the run's folder")
      ->required()
      ->transform(support::orItsFolder("results.h5"));
  support::addOut(*sinkage, s.folder, "output folder; default: the results folder");
  sinkage->add_option(
      "--shoes", s.shoes,
      "write and plot height and sinkage of these shoes only, counted from 0, e.g. 10-13,20 (sinkage_shoes.csv)");
  sinkage->add_option("--track", s.track, "track to which --shoes applies: left or right; default: both")
      ->check(CLI::IsMember({"left", "right"}));
  sinkage->add_option("--control", s.control,
                      "results.h5 of the same vehicle on rigid ground, plotted for comparison with --shoes");
  sinkage->callback([command] { sinkageCommand(*command); });
}

} // namespace grouser::commands
