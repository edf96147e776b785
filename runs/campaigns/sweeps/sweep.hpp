// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/runner.hpp"

/// Many runs of one scene, over the product of all given values.
///
/// Each run is a process of its own, so that one that fails, or crashes, takes no other with it, and that all memory
/// comes back between two runs.
namespace grouser::sweeps {

/// Runs what is not there yet (runMissing()). summary.csv is written anew after every run; where seeds are swept,
/// intervals.csv at the end. Returns the number of failed runs. Throws InputError, before anything is started, where
/// the folder holds something of other origin. Where `options.from` is given all runs branch from one state a seed.
int runSweep(const SweepPlan& plan, const SweepOptions& options);

} // namespace grouser::sweeps
