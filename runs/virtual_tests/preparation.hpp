// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/plan.hpp"

#include <functional>

/// How beds of a porosity are prepared.
namespace grouser::virtual_tests {

/// Columns of the trials: friction while the bed settles, and the porosity it comes to.
inline const std::vector<std::string> kPreparationColumns = {"preparation friction [-]", "porosity [-]"};

/// Next friction to try for a porosity, between trials so far (as rows of kPreparationColumns); 0 where one of them is
/// within `tolerance`, or the porosity is out of reach. Frictions lie in [kLeastSettlingFriction,
/// kMostSettlingFriction].
double nextFriction(const std::vector<std::vector<double>>& trials, double porosity, double tolerance);
inline constexpr double kLeastSettlingFriction = 0.005, kMostSettlingFriction = 2;

/// The row of the trials whose porosity is nearest.
const std::vector<double>& nearestTrial(const std::vector<std::vector<double>>& trials, double porosity);

/// Tries frictions on small beds of the plan's grains, rained in lifts as the plates' are, until one settles to the
/// soil's porosity; none where it names no porosity.
jobs::Table findPreparation(const TestPlan& plan, const std::filesystem::path& folder, const base::Exec& exec,
                            const std::function<void(const std::string&)>& tell);

} // namespace grouser::virtual_tests
