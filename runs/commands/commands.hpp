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
  std::string device;         ///< empty: as the scene says
  std::optional<int> threads; ///< empty: as the scene says
  std::string folder;         ///< empty: as the scene says
  std::optional<std::int64_t> steps;
  bool force = false;
  bool cache = true; ///< use the cache of settled beds
  bool hash = false;
  bool verbose = false; ///< print ledger, momentum, times and all files
  std::string beside;   ///< folder of another run to print in a second column; empty: none
  bool resume = false;
  std::string checkpoint; ///< checkpoint for --resume; empty: the one in the folder
  std::string replay;     ///< folder of the run to repeat, instead of a scene; empty: none
  std::string until;      ///< "rest": stop before the drive; empty: at the end
  std::string commandLine;
  const base::Ranks* ranks = nullptr; ///< ranks of the run
};
void runCommand(const RunCommand& command);

struct SweepCommand {
  std::string scene;
  sweeps::SweepLists lists;
  std::optional<scene::TerrainKind> ground; ///< empty: as the scene says
  std::string device;                       ///< empty: as the scene says
  std::optional<int> threads;               ///< empty: as the scene says
  std::string folder;                       ///< empty: out/NAME_sweep
  int jobs = 1;
  double seconds = 0; ///< no run starts after this wall time; 0: no limit
  bool force = false;
  bool branches = false;  ///< all runs branch from one checkpoint
  std::string checkpoint; ///< checkpoint to branch from; empty: the sweep settles the vehicle first
};
/// Throws SimulationError after all runs have ended, if one has failed.
void sweepCommand(const SweepCommand& command);

struct HashCommand {
  std::string checkpoint;
};
void hashCommand(const HashCommand& command);

struct SinkageCommand {
  std::string results;
  std::string folder;  ///< empty: beside the results
  std::string shoes;   ///< a list "10-13,20"; empty: all
  std::string track;   ///< track of these shoes: "left" or "right"; empty: both
  std::string control; ///< results of the same vehicle on rigid ground, drawn behind those shoes; empty: none
};
/// Throws InputError for unknown shoes, and for a track or control without shoes.
void sinkageCommand(const SinkageCommand& command);

struct PlanCommand {
  std::string scene;
  std::vector<std::string> overrides;
  int ranks = 1;              ///< number of ranks of the planned run
  std::string device;         ///< empty: as the scene says
  std::optional<int> threads; ///< empty: as the scene says
  std::string folder;         ///< results folder; empty: as the scene says
  bool forecast = true;       ///< predict the run time, by a short probe
  bool probe = false;         ///< use the long probe
  bool cache = true;          ///< use the caches of settled beds and sphere sets, as in a run
  std::string json;           ///< file for the forecast; empty: none
};
/// Throws InputError, after printing, if the run does not fit this machine.
void planCommand(const PlanCommand& command);

struct SpheresCommand {
  std::string mesh;
  double radius = 0;     ///< [m]; 0: from count
  std::size_t count = 0; ///< 0: from radius
  std::string csv;       ///< file for the spheres; empty: none
  bool force = false;    ///< overwrite that file
};
void spheresCommand(const SpheresCommand& command);

struct SoilsCommand {
  std::string soil;      ///< name or path; empty: a list of all
  bool markdown = false; ///< the table of docs/soils.md
};
void soilsCommand(const SoilsCommand& command);

struct FieldsCommand {
  bool soil = false;     ///< the keys of a soil file
  bool vehicle = false;  ///< the keys of a vehicle file, not of a scene
  bool files = false;    ///< contents of results files, as in docs/files.md
  bool markdown = false; ///< all keys, as in docs/keys.md
};
void fieldsCommand(const FieldsCommand& command);

} // namespace grouser::commands
