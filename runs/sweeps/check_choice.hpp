// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/sweeps/check_cases.hpp"

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
};

/// Without a budget every case gets `seeds` runs, or one where seeds make no difference. The skin has one: bits are
/// alike or not.
///
/// With a budget [s]: three seeds of the base; then each case in its order with three, if the whole of it still fits;
/// then a seed more for all that were taken, as long as that fits, up to `seeds`. `baseSeconds`: of one run of the base
/// when `jobs` go at the same time.
CheckChoice chooseRuns(const CheckCases& cases, int seeds, std::optional<double> budget, double baseSeconds, int jobs);

/// "90", "90s", "20min", "1.5h" in seconds. Throws InputError for anything else, and for less than a second.
double budgetSeconds(const std::string& text);

} // namespace grouser::sweeps
