// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/vehicle_setup.hpp"

namespace grouser::scene {
struct Hitch;
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// Of a hitch's rope or bar [N/m]: as given, or such that hull (and sled) would swing on it at 10 Hz. 0 without either.
double hitchStiffness(const scene::Hitch& hitch, const vehicle::VehicleSpec& spec);
/// What swings on it [kg]: the hull, or hull and sled against each other.
double hitchedMass(const scene::Hitch& hitch, const vehicle::VehicleSpec& spec);

/// Reads the spec. Throws InputError where that, or where the vehicle stands, is not possible.
coupling::VehicleSetup vehicleSetup(const scene::Scene& scene);

/// Takes the vehicle out of the scene, with all that only a vehicle has: driver, hitch, stop, its columns of the
/// output.
void removeVehicle(scene::Scene& scene);

} // namespace grouser::setup
