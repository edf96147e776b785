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

/// Options of one call of `grouser events`, or of `grouser map`, which has a single event.
struct EventsCommand {
  EventOptions options;
  jobs::PieceOptions pieces; ///< resume, part, seconds, device, threads
  std::string folder;        ///< results folder; empty: default of folderOf()
  int jobs = 1;              ///< number of concurrent runs
  bool force = false;        ///< repeat finished runs, and overwrite the folder
  bool plan = false;         ///< only print the estimated run time
  bool films = false;
  std::vector<std::string> against; ///< results folders of other `grouser events` calls to compare with
  double percent = 5;               ///< tolerance of the verdict "equal" [% of the larger mean]
  std::string words;                ///< the whole command line
};

/// Result folder: --out, or out/WHAT_VEHICLE_SOIL with _scm on deformable soil and _quick on coarse beds.
std::filesystem::path folderOf(const EventsCommand& command, const std::string& what);

/// Event options, completed with device, threads and frames of the call.
EventOptions optionsOfRuns(const EventsCommand& command);

/// File call.json (of a map: map_call.json) with the options that determine the runs. `axis`: second axis of a map.
jobs::Recipe recipeOf(const EventsCommand& command, const std::filesystem::path& folder, const std::string& axis = "");

/// Throws base::InputError if the folder contains files that do not belong to this call.
void checkFolder(const EventsCommand& command, const std::filesystem::path& folder, const jobs::Recipe& call);

/// Prints vehicle, ground, beds and number of runs.
void printHead(const EventsCommand& command, const std::string& what, const EventPlan& plan, std::size_t runs);

/// Command, machine and common settings for a results file.
nlohmann::ordered_json headJson(const EventsCommand& command, const EventPlan& plan);

/// Performs the missing runs. With --part, performs only that part and returns no outcomes.
std::vector<sweeps::SweepOutcome> doRuns(const EventsCommand& command, const std::string& what,
                                         const sweeps::SweepPlan& plan, const std::filesystem::path& folder,
                                         const jobs::Recipe& call);

/// Throws base::SimulationError if runs failed for reasons unrelated to the vehicle. `table`: file that lists them.
void throwOnUnknownFailures(const std::vector<EventRow>& rows, const std::filesystem::path& table);

} // namespace grouser::events
