// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/runner.hpp"

namespace grouser::sweeps {

/// Plan whose runs branch from `options.from` or, if that is empty, from the vehicle at rest: one settling run per seed
/// in the sweep's folder, performed first if missing. Throws InputError before any run if the runs of a seed differ in
/// a key that affects the state; SimulationError if the vehicle does not come to rest.
SweepPlan branched(const SweepPlan& plan, const SweepOptions& options);

} // namespace grouser::sweeps
