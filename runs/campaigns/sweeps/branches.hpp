// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/runner.hpp"

namespace grouser::sweeps {

/// Plan with runs that branch from `options.from` or, if it is empty, from the vehicle at rest. In that case, missing
/// settling runs (one per seed, in the sweep's folder) are performed first. Throws InputError before any run if runs
/// with equal seeds differ in a key that affects the state at rest; SimulationError if the vehicle never rests.
SweepPlan branched(const SweepPlan& plan, const SweepOptions& options);

} // namespace grouser::sweeps
