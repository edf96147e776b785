// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/vehicle_setup.hpp"

namespace grouser::scene {
struct Hitch;
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// Stiffness of a hitch's rope or bar [N/m]: as given, or for an oscillation of the hull (and sled) at 10 Hz. 0 for
/// hitches without rope or bar.
double hitchStiffness(const scene::Hitch& hitch, const vehicle::VehicleSpec& spec);
/// Oscillating mass of the hitch [kg]: the hull, or the reduced mass of hull and sled.
double hitchedMass(const scene::Hitch& hitch, const vehicle::VehicleSpec& spec);

/// Reads the vehicle file. Throws InputError if the file or the position of the vehicle is invalid.
coupling::VehicleSetup vehicleSetup(const scene::Scene& scene);

/// Removes the vehicle from the scene, with driver, hitch, stop, and its output columns.
void removeVehicle(scene::Scene& scene);

} // namespace grouser::setup
