// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

/// Commands of the program: each adds itself and its options to the command line. A new command needs a file
/// NAME_options.cpp and a line in allCommands().
namespace grouser::commands {

/// MPI ranks and command line of the program.
struct Invocation {
  const base::Ranks& ranks;
  std::string words; ///< the whole command line
};

enum class RankUse {
  shared,    ///< all ranks work together
  firstRank, ///< the first rank works, the others exit
  refused    ///< error if started on several ranks
};

struct CommandEntry {
  std::string name; ///< the first word of the command line
  /// Adds the subcommand. Its callback performs the command and keeps the variables of the options alive.
  void (*add)(CLI::App& app, const Invocation& invocation);
  RankUse ranks = RankUse::firstRank;
  std::string insteadOfRanks{}; ///< RankUse::refused: end of the error message
};

/// All commands, in the order of `grouser --help`.
std::vector<CommandEntry> allCommands();

constexpr const char* kSetHelp =
    "override a scene key, e.g. driver.sprocket_speed=2, or remove it, e.g. ~terrain.tile; may be repeated";

void addRun(CLI::App& app, const Invocation& invocation);
void addSweep(CLI::App& app, const Invocation& invocation);
void addCheck(CLI::App& app, const Invocation& invocation);
void addCompare(CLI::App& app, const Invocation& invocation);
void addEvents(CLI::App& app, const Invocation& invocation);
void addMap(CLI::App& app, const Invocation& invocation);
void addPlan(CLI::App& app, const Invocation& invocation);
void addBench(CLI::App& app, const Invocation& invocation);
void addHash(CLI::App& app, const Invocation& invocation);
void addStudy(CLI::App& app, const Invocation& invocation);
void addSoil(CLI::App& app, const Invocation& invocation);
void addRender(CLI::App& app, const Invocation& invocation);
void addSinkage(CLI::App& app, const Invocation& invocation);
void addReport(CLI::App& app, const Invocation& invocation);
void addSpheres(CLI::App& app, const Invocation& invocation);
void addFields(CLI::App& app, const Invocation& invocation);
void addSoils(CLI::App& app, const Invocation& invocation);
void addManual(CLI::App& app, const Invocation& invocation);

} // namespace grouser::commands
