// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_cases.hpp"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Selection of the runs of a check.
namespace grouser::sweeps {

/// Number of seeds of each case.
struct CheckChoice {
  std::vector<int> seeds;                ///< [cases]; 0: none
  std::vector<std::size_t> beyondBudget; ///< cases that exceed the budget
  double seconds = 0;                    ///< estimated time, from the cost of one base run [s]

  bool operator==(const CheckChoice&) const = default;
};

/// Costs of runs, measured in one base run. The first of the runs that share a bed settles it, unless it is cached.
struct RunCosts {
  double run = 0;        ///< time of a base run without settling [s]
  double settling = 0;   ///< settling time of the base bed [s]
  std::vector<int> beds; ///< [cases] equal numbers share a bed per seed; empty: each run has its own
  std::function<bool(int bed, int seed)> isKept; ///< whether a bed is cached, by seed offset; empty: none
};

/// Without a budget every case gets `seeds` runs, or one without seed dependence. The skin case gets one: its results
/// are bitwise equal or not.
///
/// With a budget [s]: three seeds of the base; then three of each case in order, if they fit; then one more
/// seed for all selected cases while it fits, up to `seeds`. `costs`: with `jobs` concurrent runs.
CheckChoice chooseRuns(const CheckCases& cases, int seeds, std::optional<double> budget, const RunCosts& costs,
                       int jobs);
inline constexpr int kFewSeeds = 3; ///< smallest useful sample for an interval

/// Total time of `seeds` runs of each case in sequence [s].
double secondsOf(const CheckCases& cases, const RunCosts& costs, const std::vector<int>& seeds);

/// Choice stored for resumed calls; empty if it does not match these cases or exceeds `most` seeds.
nlohmann::json choiceJson(const CheckChoice& choice);
std::optional<CheckChoice> keptChoice(const nlohmann::json& json, const CheckCases& cases, int most);

/// "90", "90s", "20min", "1.5h" in seconds. Throws InputError for anything else, for less than a second and for more
/// than 10,000 hours.
double budgetSeconds(const std::string& text);

} // namespace grouser::sweeps
