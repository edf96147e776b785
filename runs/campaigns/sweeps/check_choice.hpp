// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_cases.hpp"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Which runs of a check are made.
namespace grouser::sweeps {

/// Of which case how many seeds are run.
struct CheckChoice {
  std::vector<int> seeds;                ///< [cases]; 0: none
  std::vector<std::size_t> beyondBudget; ///< cases that did not fit
  double seconds = 0;                    ///< that all of it takes by the cost of one run of the base [s]

  bool operator==(const CheckChoice&) const = default;
};

/// What runs cost, as one run of the base has told. Of all runs that have one bed the first settles it, unless an
/// earlier run has kept it.
struct RunCosts {
  double run = 0;        ///< one of the base, but for its bed's settling [s]
  double settling = 0;   ///< of the base's bed [s]
  std::vector<int> beds; ///< [cases] those of one number have one bed for each seed; empty: each run has its own
  std::function<bool(int bed, int seed)> isKept; ///< of the seed after so many; empty: none is
};

/// Without a budget every case gets `seeds` runs, or one where seeds make no difference. The skin has one: bits are
/// alike or not.
///
/// With a budget [s]: three seeds of the base; then each case in its order with three, if the whole of it still fits;
/// then a seed more for all that were taken, as long as that fits, up to `seeds`. `costs`: when `jobs` runs go at the
/// same time.
CheckChoice chooseRuns(const CheckCases& cases, int seeds, std::optional<double> budget, const RunCosts& costs,
                       int jobs);
inline constexpr int kFewSeeds = 3; ///< with which an interval begins to say something

/// Total time of `seeds` runs of each case, run one after another [s].
double secondsOf(const CheckCases& cases, const RunCosts& costs, const std::vector<int>& seeds);

/// A choice as it is kept for calls that go on; empty where it is none of these cases, or asks for more than `most`
/// seeds.
nlohmann::json choiceJson(const CheckChoice& choice);
std::optional<CheckChoice> keptChoice(const nlohmann::json& json, const CheckCases& cases, int most);

/// "90", "90s", "20min", "1.5h" in seconds. Throws InputError for anything else, for less than a second and for more
/// than 10,000 hours.
double budgetSeconds(const std::string& text);

} // namespace grouser::sweeps
