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

/// Chosen number of seeds of each case.
struct CheckChoice {
  std::vector<int> seeds;                ///< [cases]; 0: not run
  std::vector<std::size_t> beyondBudget; ///< indices of cases that exceed the budget
  double seconds = 0;                    ///< time estimated from the cost of one base run [s]

  bool operator==(const CheckChoice&) const = default;
};

/// Costs of runs, measured in one base run. The first of several runs with the same bed settles it, unless the bed is
/// cached.
struct RunCosts {
  double run = 0;        ///< time of a base run without settling [s]
  double settling = 0;   ///< settling time of the base bed [s]
  std::vector<int> beds; ///< [cases] cases with equal numbers share one bed per seed; empty: one bed per run
  std::function<bool(int bed, int seed)> isKept; ///< whether the bed of a seed offset is cached; empty: never
};

/// Without a budget, each case has `seeds` runs, or one run without seed dependence. The skin case has one run, because
/// its results must be bitwise equal.
///
/// With a budget [s]: three seeds of the base; then three seeds of each case in order, if they fit; then one more
/// seed at a time for all selected cases while it fits, up to `seeds`. `jobs`: number of concurrent runs.
CheckChoice chooseRuns(const CheckCases& cases, int seeds, std::optional<double> budget, const RunCosts& costs,
                       int jobs);
inline constexpr int kFewSeeds = 3; ///< smallest useful sample for an interval

/// Total time of `seeds` runs of each case in sequence [s].
double secondsOf(const CheckCases& cases, const RunCosts& costs, const std::vector<int>& seeds);

/// Stored choice of an earlier call; empty if it does not match these cases or exceeds `most` seeds.
nlohmann::json choiceJson(const CheckChoice& choice);
std::optional<CheckChoice> keptChoice(const nlohmann::json& json, const CheckCases& cases, int most);

/// Converts "90", "90s", "20min", "1.5h" to seconds. Throws InputError for other formats, for less than a second and
/// for more than 10,000 hours.
double budgetSeconds(const std::string& text);

} // namespace grouser::sweeps
