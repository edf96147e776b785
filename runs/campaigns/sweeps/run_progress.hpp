// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/sweep_plan.hpp"

#include <filesystem>

/// Progress of runs in other processes.
namespace grouser::sweeps {

/// Expected simulated time at the end of a run [s]; at most run.duration. Most runs with [stop] end earlier.
double expectedEnd(const SweepRun& run);

/// Relative work of a run in a sweep [grain s]: expectedEnd() times the number of grains; a vehicle counts as twenty
/// thousand grains. Ignores time steps and settling.
double workOf(const SweepRun& run);

/// Simulated time of the last row in the folder [s]; 0 without rows.
double timeReached(const std::filesystem::path& folder);

} // namespace grouser::sweeps
