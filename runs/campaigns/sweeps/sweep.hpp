// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/runner.hpp"

/// Runs of one scene over the product of all values.
///
/// Each run is a process, so that a failure or crash does not affect others and all memory is released after it.
namespace grouser::sweeps {

/// Performs missing runs (runMissing()). Rewrites summary.csv after every run and, if seeds are swept, writes
/// intervals.csv at the end. Returns the number of failed runs. Throws InputError before any run starts if the folder
/// contains other files. With `options.from`, all runs branch from one state per seed.
int runSweep(const SweepPlan& plan, const SweepOptions& options);

} // namespace grouser::sweeps
