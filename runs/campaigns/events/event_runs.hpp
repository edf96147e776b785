// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_report.hpp"
#include "runs/jobs/pieces.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

/// Runs of events, shared by `grouser events` and `grouser map`.
namespace grouser::events {

/// Options of a call of events, or of a map of one event.
struct EventsCommand {
  EventOptions options;
  jobs::PieceOptions pieces; ///< resume, part, seconds, device, threads
  std::string folder;        ///< empty: as folderOf() has it
  int jobs = 1;              ///< runs at the same time
  bool force = false;        ///< run again what has been run, and overwrite the folder
  bool plan = false;         ///< say how long it would take, and run nothing
  bool films = false;
  std::vector<std::string> against; ///< folders of other events, whose figures stand beside these
  double percent = 5;               ///< of the larger mean, within which verdicts call two figures equal
  std::string words;                ///< the whole command line
};

/// The folder of the results: --out, or out/WHAT_VEHICLE_SOIL with _scm on deformable soil and _quick on coarse beds.
std::filesystem::path folderOf(const EventsCommand& command, const std::string& what);

/// The options of the runs: those of the user, with the device and threads of the call, and frames for films.
EventOptions optionsOfRuns(const EventsCommand& command);

/// call.json, of a map map_call.json: all that decides which runs there are. `axis`: of a map.
jobs::Recipe recipeOf(const EventsCommand& command, const std::filesystem::path& folder, const std::string& axis = "");

/// Throws base::InputError where the folder holds something else than runs of this call.
void checkFolder(const EventsCommand& command, const std::filesystem::path& folder, const jobs::Recipe& call);

/// Vehicle, ground and beds, and how many runs there are.
void printHead(const EventsCommand& command, const std::string& what, const EventPlan& plan, std::size_t runs);

/// The call, the machine and what all runs have in common, for a file of results.
nlohmann::ordered_json headJson(const EventsCommand& command, const EventPlan& plan);

/// Does the runs that are missing, or of them the call's part: then the outcomes are empty, as there is no table.
std::vector<sweeps::SweepOutcome> doRuns(const EventsCommand& command, const std::string& what,
                                         const sweeps::SweepPlan& plan, const std::filesystem::path& folder,
                                         const jobs::Recipe& call);

/// Throws base::SimulationError where runs have failed for a cause that is not the vehicle's. `table`: that names them.
void throwOnUnknownFailures(const std::vector<EventRow>& rows, const std::filesystem::path& table);

} // namespace grouser::events
