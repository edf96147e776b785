// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation_state.hpp"
#include "coupling/vehicle_setup.hpp"

namespace grouser::coupling {

/// Converts the state of one run to the initial state of another with a different driver, hitch or both: `setup` is the
/// vehicle of the new run, `time` [s] that of the state. The new driver takes over (Driver::takeOver()); the former
/// hitch is released, its work remains in the ledger; the new hitch engages at `time` at the earliest, with work 0.
/// Bodies, grains and contacts are unchanged.
void branch(SimulationState& state, const VehicleSetup& setup, bool otherDriver, bool otherHitch, double time);

} // namespace grouser::coupling
