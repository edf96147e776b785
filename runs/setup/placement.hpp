// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/vehicle_setup.hpp"
#include "terrain/height_field.hpp"

#include <optional>

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// The vehicle file of the scene, with the scene's keys; a single track lies in the middle. Throws InputError.
vehicle::VehicleSpec vehicleSpec(const scene::Scene& scene);

/// The scene's terrain in the plane; empty without one.
std::optional<terrain::Rectangle> terrainArea(const scene::Scene& scene);

/// As the scene says; else in the middle across its heading, with its rear at the terrain's border. Needs no bed yet.
/// Throws InputError when the vehicle does not stand wholly on the terrain.
coupling::Placement placeVehicle(const scene::Scene& scene, const vehicle::VehicleSpec& spec);

/// The parts' meshes must be there and fit the scene's vehicle.sphere_radius. Throws InputError before a bed takes its
/// time; cutting them checks the same, but knows of no scene.
void checkParts(const scene::Scene& scene);

} // namespace grouser::setup
