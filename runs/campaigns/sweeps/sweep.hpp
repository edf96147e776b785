// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/runner.hpp"

/// Runs of one scene for all combinations of values.
///
/// Each run is a separate process: a failure or crash does not affect other runs, and its end releases all memory.
namespace grouser::sweeps {

/// Performs missing runs (runMissing()). Rewrites summary.csv after each run; with several seeds, writes intervals.csv
/// at the end. Returns the number of failed runs. Throws InputError before any run starts if the folder contains other
/// files. With `options.from`, all runs of a seed branch from the same state.
int runSweep(const SweepPlan& plan, const SweepOptions& options);

} // namespace grouser::sweeps
