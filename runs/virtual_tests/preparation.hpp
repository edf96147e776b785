// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/plan.hpp"

#include <functional>

/// Preparation of beds with a target porosity.
namespace grouser::virtual_tests {

/// Columns of the trials: friction during settling, and resulting porosity.
inline const std::vector<std::string> kPreparationColumns = {"preparation friction [-]", "porosity [-]"};

/// Next friction to try for a porosity, from trials (rows of kPreparationColumns); 0 if one is within `tolerance`, or
/// the porosity is out of reach. Frictions lie in [kLeastSettlingFriction, kMostSettlingFriction].
double nextFriction(const std::vector<std::vector<double>>& trials, double porosity, double tolerance);
inline constexpr double kLeastSettlingFriction = 0.005, kMostSettlingFriction = 2;

/// The trial with the closest porosity.
const std::vector<double>& nearestTrial(const std::vector<std::vector<double>>& trials, double porosity);

/// Tries frictions on small beds, rained in lifts like those of the plates, until one settles to the soil's porosity;
/// empty without a porosity.
jobs::Table findPreparation(const TestPlan& plan, const std::filesystem::path& folder, const base::Exec& exec,
                            const std::function<void(const std::string&)>& tell);

} // namespace grouser::virtual_tests
