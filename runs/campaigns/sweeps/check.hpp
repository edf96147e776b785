// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_options.hpp"

#include <filesystem>

/// Error bars of a scene's figures from time step, seed, bed size, grain size, spheres and precision, and the cost of
/// the runs.
namespace grouser::sweeps {

/// Performs the missing runs, each in a separate process, and writes check.json, series.csv, costs.json and check.png
/// into the folder. Settled beds are shared with other runs. A killed check can be resumed: its files, except
/// costs.json and its plots, do not depend on interruptions or `jobs`. With a budget, the cost of the first run
/// determines the choice of runs, which choice.json stores for resumed calls. With figures, runs are added at interim
/// looks until the target error bars are reached: see check_goals.hpp.
///
/// A failed run is a result and is reported with its message; the other runs continue. Throws InputError for an
/// invalid scene or option before any run starts; SimulationError at the end if no run of the unchanged scene
/// finished, or if the skin of the neighbour lists changed the results.
void runCheck(const std::filesystem::path& scene, const CheckOptions& options);

} // namespace grouser::sweeps
