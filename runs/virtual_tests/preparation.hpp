// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/plan.hpp"

#include <functional>

/// Preparation of beds with a target porosity.
namespace grouser::virtual_tests {

/// Columns of the trials: settling friction and resulting porosity.
inline const std::vector<std::string> kPreparationColumns = {"preparation friction [-]", "porosity [-]"};

/// Next friction to try for a porosity, from earlier trials (rows of kPreparationColumns); 0 if a trial is within
/// `tolerance` or no friction in [kMinSettlingFriction, kMaxSettlingFriction] reaches the porosity.
double nextFriction(const std::vector<std::vector<double>>& trials, double porosity, double tolerance);
inline constexpr double kMinSettlingFriction = 0.005, kMaxSettlingFriction = 2;

/// The trial with the closest porosity.
const std::vector<double>& nearestTrial(const std::vector<std::vector<double>>& trials, double porosity);

/// Tries frictions on small beds, rained in lifts like the beds of the plates, until a bed has the soil's porosity.
/// The table is empty if the soil has no porosity.
jobs::Table findPreparation(const TestPlan& plan, const std::filesystem::path& folder, const base::Exec& exec,
                            const std::function<void(const std::string&)>& report);

} // namespace grouser::virtual_tests
