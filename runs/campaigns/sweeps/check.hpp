// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_options.hpp"

#include <filesystem>

/// Error bars of a scene's figures by step, seed, extent of the bed, grain size, spheres and precision, and their
/// costs.
namespace grouser::sweeps {

/// Performs the missing runs, one process each, and writes check.json, series.csv, costs.json and check.png into the
/// folder; settled beds are shared with other runs. A killed check resumes: its files, except costs.json and plots of
/// it, do not depend on interruptions or `jobs`. With a budget, the cost of the first run determines the choice of
/// runs, which choice.json keeps for resumed calls. With figures, runs are added at looks until their error bars are
/// met: see check_goals.hpp.
///
/// A failed run is a result, reported with its message; the others continue. Throws
/// InputError for an invalid scene or option before any run starts; SimulationError at the end if no run of the
/// unchanged scene finished, or if the skin of the neighbour lists changed the results.
void runCheck(const std::filesystem::path& scene, const CheckOptions& options);

} // namespace grouser::sweeps
