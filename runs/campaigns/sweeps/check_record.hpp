// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_goals.hpp"
#include "runs/campaigns/sweeps/check_results.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace grouser::sweeps {

/// Cost of a case: medians over its finished runs; NaN without finished runs.
struct CaseCost {
  double wall = 0, cpu = 0; ///< [s] wall time of a run with preparation; CPU time of its steps, all threads
  double steps = 0;
};

/// Data of a report, except the results.
struct CheckRecord {
  std::filesystem::path folder; ///< folder of the check
  CheckCases cases;
  CheckRuns runs;
  std::vector<SweepOutcome> outcomes;
  std::vector<CaseCost> costs;           ///< [cases] see costsOf()
  std::vector<std::size_t> beyondBudget; ///< cases that exceed the budget
  std::string scene, origin;             ///< scene file; hash of everything that determines the results
  int jobs = 1;                          ///< concurrent runs
  Looks looks;                           ///< looks of a check with --of; otherwise empty
  std::vector<Goal> goals;               ///< goals of a check with --of; otherwise empty
  std::vector<std::vector<int>> toReach; ///< [goals][cases] see seedsToReach()
  bool isWhole = true;                   ///< all selected runs have ended
};

/// Costs [cases] from the manifests of the runs.
std::vector<CaseCost> costsOf(const CheckRecord& record);

/// "finished", "incomplete", "failed" (all runs), "partly failed", "refused", "left out" or "not begun", with a message
/// if there is one.
struct CaseStatus {
  std::string word, message;
  bool isNeeded = true; ///< false: left out because the case cannot change a verdict
};
CaseStatus statusOf(const CheckRecord& record, std::size_t aCase);

} // namespace grouser::sweeps
