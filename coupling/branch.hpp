// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation_state.hpp"
#include "coupling/vehicle_setup.hpp"

namespace grouser::coupling {

/// Makes the state of one run the begin of another, with another driver, hitch or both: `setup` is of the vehicle as it
/// goes on, `time` [s] that of the state. The new driver takes over (Driver::takeOver()); the former hitch lets go, its
/// work stays in the ledger; the new one takes hold here at the earliest, with books that begin at 0. Bodies, grains
/// and contacts stay as they are.
void branch(SimulationState& state, const VehicleSetup& setup, bool otherDriver, bool otherHitch, double time);

} // namespace grouser::coupling
