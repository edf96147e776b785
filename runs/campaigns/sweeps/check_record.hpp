// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_goals.hpp"
#include "runs/campaigns/sweeps/check_results.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace grouser::sweeps {

/// Cost of one case: medians over the runs that have ended; NaN if none has.
struct CaseCost {
  double wall = 0, cpu = 0; ///< [s] a run, preparation included; in steps alone, all threads together
  double steps = 0;
};

/// All that a report tells of, but for the results themselves.
struct CheckRecord {
  std::filesystem::path folder; ///< of the check
  CheckCases cases;
  CheckRuns runs;
  std::vector<SweepOutcome> outcomes;
  std::vector<CaseCost> costs;           ///< [cases] see costsOf()
  std::vector<std::size_t> beyondBudget; ///< cases that the budget left out
  std::string scene, origin;             ///< its file; hash of what decides its results
  int jobs = 1;                          ///< runs at the same time
  Looks looks;                           ///< of a check with --of; else empty
  std::vector<Goal> goals;               ///< likewise
  std::vector<std::vector<int>> toReach; ///< [goals][cases] seeds that likely reach it; empty: see seedsToReach()
  bool isWhole = true;                   ///< all runs chosen have ended
};

/// [cases] from the manifests of the runs.
std::vector<CaseCost> costsOf(const CheckRecord& record);

/// "finished", "incomplete", "failed" (all runs), "partly failed", "refused", "left out" or "not begun", with the
/// message behind it where there is one.
struct CaseStatus {
  std::string word, message;
  bool isNeeded = true; ///< false: left out because it could not change a verdict
};
CaseStatus statusOf(const CheckRecord& record, std::size_t aCase);

} // namespace grouser::sweeps
