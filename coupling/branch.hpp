// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation_state.hpp"
#include "coupling/vehicle_setup.hpp"

namespace grouser::coupling {

/// Makes the state of one run the start of another with another driver, hitch or both: `setup` is the vehicle of the
/// new run, `time` [s] that of the state. The new driver takes over (Driver::takeOver()); the former hitch releases,
/// its work stays in the ledger; the new one attaches here at the earliest, with work 0. Bodies, grains and contacts
/// are unchanged.
void branch(SimulationState& state, const VehicleSetup& setup, bool otherDriver, bool otherHitch, double time);

} // namespace grouser::coupling
