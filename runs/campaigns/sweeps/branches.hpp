// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/runner.hpp"

namespace grouser::sweeps {

/// The plan with runs that branch from `options.from`, or, where that is empty, from the vehicle at rest: a run to
/// there for each seed, in the sweep's folder, which is made first unless it is there. Throws InputError, before
/// anything is run, where the runs of a seed differ in a key that has shaped the state; SimulationError where the
/// vehicle does not come to rest.
SweepPlan branched(const SweepPlan& plan, const SweepOptions& options);

} // namespace grouser::sweeps
