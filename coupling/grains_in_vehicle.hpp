// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground_setup.hpp"
#include "coupling/vehicle_rig.hpp"

namespace grouser::coupling {

/// Throws InputError if a grain of the scene's sections penetrates a part of the vehicle at the start by more than
/// run.max_overlap of its radius. Grains of the bed are below the vehicle, which is placed above them. `shoesAlone`:
/// only shoes are in contact with grains.
void requireApartFromVehicle(const GrainsSetup& grains, const VehicleRig& vehicle, bool shoesAlone);

} // namespace grouser::coupling
