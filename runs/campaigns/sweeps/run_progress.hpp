// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/sweep_plan.hpp"

#include <filesystem>

/// How far runs are, as seen from outside.
namespace grouser::sweeps {

/// Simulated time at which a run will likely end [s]: what its plan expects, at most run.duration. Where [stop] ends
/// runs, their duration is a limit that few reach.
double expectedEnd(const SweepRun& run);

/// Work of a run beside that of another of the same sweep: its expectedEnd() times its grains, a vehicle being as much
/// as twenty thousand of them [grain s]. Steps of other lengths and beds that have yet to settle are not in it.
double workOf(const SweepRun& run);

/// Simulated time of the last row that the run in this folder wrote [s]; 0 where it has written none.
double timeReached(const std::filesystem::path& folder);

} // namespace grouser::sweeps
