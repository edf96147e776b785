// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "runs/campaigns/sweeps/sweep_plan.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Actions of the program's commands, after parsing. All throw; `main` catches.
namespace grouser::commands {

struct RunCommand {
  std::string scene;
  std::vector<std::string> overrides;
  std::string device;         ///< empty: value of the scene
  std::optional<int> threads; ///< empty: value of the scene
  std::string folder;         ///< empty: value of the scene
  std::optional<std::int64_t> steps;
  bool force = false;
  bool cache = true; ///< use the cache of settled beds
  bool hash = false;
  bool verbose = false; ///< print ledger, momentum, times and all files
  std::string beside;   ///< folder of another run to print in a second column; empty: no second column
  bool resume = false;
  std::string checkpoint; ///< checkpoint for --resume; empty: the one in the folder
  std::string replay;     ///< folder of the run to repeat, instead of a scene; empty: none
  std::string until;      ///< "rest": stop before the drive; empty: run to the end
  std::string commandLine;
  const base::Ranks* ranks = nullptr; ///< ranks of the run
};
void runCommand(const RunCommand& command);

struct SweepCommand {
  std::string scene;
  sweeps::SweepLists lists;
  std::optional<scene::TerrainKind> ground; ///< empty: value of the scene
  std::string device;                       ///< empty: value of the scene
  std::optional<int> threads;               ///< empty: value of the scene
  std::string folder;                       ///< empty: out/NAME_sweep
  int jobs = 1;
  double seconds = 0; ///< start no new runs after this wall time [s]; 0: no limit
  bool force = false;
  bool branches = false;  ///< all runs branch from one checkpoint
  std::string checkpoint; ///< checkpoint to branch from; empty: the sweep settles the vehicle first
};
/// Throws SimulationError at the end if a run has failed.
void sweepCommand(const SweepCommand& command);

struct HashCommand {
  std::string checkpoint;
};
void hashCommand(const HashCommand& command);

struct SinkageCommand {
  std::string results;
  std::string folder;  ///< empty: beside the results
  std::string shoes;   ///< list of shoes, e.g. "10-13,20"; empty: all
  std::string track;   ///< track of these shoes: "left" or "right"; empty: both
  std::string control; ///< results of the same vehicle on rigid ground, plotted for comparison; empty: none
};
/// Throws InputError for unknown shoes, and for a track or control without shoes.
void sinkageCommand(const SinkageCommand& command);

struct PlanCommand {
  std::string scene;
  std::vector<std::string> overrides;
  int ranks = 1;              ///< number of ranks of the planned run
  std::string device;         ///< empty: value of the scene
  std::optional<int> threads; ///< empty: value of the scene
  std::string folder;         ///< results folder; empty: folder of the scene
  bool forecast = true;       ///< predict the run time with a short probe
  bool probe = false;         ///< use the long probe
  bool cache = true;          ///< use the caches of settled beds and sphere sets, as in a run
  std::string json;           ///< file for the forecast; empty: none
};
/// Throws InputError, after printing the plan, if the run exceeds the resources of this machine.
void planCommand(const PlanCommand& command);

struct SpheresCommand {
  std::string mesh;
  double radius = 0;     ///< sphere radius [m]; 0: determined by count
  std::size_t count = 0; ///< target number of spheres; 0: determined by radius
  std::string csv;       ///< CSV file for the spheres; empty: none
  bool force = false;    ///< overwrite the CSV file
};
void spheresCommand(const SpheresCommand& command);

struct SoilsCommand {
  std::string soil;      ///< name or path of a soil; empty: list all soils
  bool markdown = false; ///< print the table of docs/soils.md
};
void soilsCommand(const SoilsCommand& command);

struct FieldsCommand {
  bool soil = false;     ///< list the keys of soil files
  bool vehicle = false;  ///< list the keys of vehicle files
  bool files = false;    ///< list the contents of results files, as in docs/files.md
  bool markdown = false; ///< list all keys, as in docs/keys.md
};
void fieldsCommand(const FieldsCommand& command);

} // namespace grouser::commands
