// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/sweep_plan.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

/// Warnings and notes that the runs of a campaign print to their logs.
namespace grouser::sweeps {

/// Warnings or notes of one kind: their texts differ in numbers only.
struct RunNotice {
  bool isWarning = false;
  std::string text;              ///< text of the first run
  bool varies = false;           ///< whether other runs print other numbers
  std::vector<std::string> runs; ///< names of the runs, in the order of the plan
};

/// Whether the scene has a vehicle on rigid terrain, where sinkage is minus the height of the pads above the ground.
bool isOnRigidGround(const scene::Scene& scene);

/// Notices in the logs of these runs, warnings first, otherwise in the order of their first run. `sinkages`: whether
/// results of these runs contain a sinkage, which requires a note on runs on rigid ground.
std::vector<RunNotice> runNotices(const SweepPlan& plan, const std::filesystem::path& folder, bool sinkages = false);

/// One line per notice: "WARNING in 2 of 6 runs: ...", "note in 1 of 6 runs: ...". `runs`: number of all runs.
std::string noticesText(const std::vector<RunNotice>& notices, std::size_t runs);

/// [notices]: {"kind": "warning" or "note", "text": ..., "runs": [names]}.
nlohmann::ordered_json noticesJson(const std::vector<RunNotice>& notices);

/// Notices of one run as the text of a table cell: "WARNING: ...; note: ...".
std::string noticesOfRun(const SweepRun& run, const std::filesystem::path& folder);

/// Prints warnings and notes on the scenes of a plan to stderr, each kind once.
void printNotesOf(const SweepPlan& plan);

} // namespace grouser::sweeps
