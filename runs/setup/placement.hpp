// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/vehicle_setup.hpp"
#include "terrain/height_field.hpp"

#include <optional>

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// The vehicle file of the scene, with the scene's keys; a single track is in the middle. Throws InputError.
vehicle::VehicleSpec vehicleSpec(const scene::Scene& scene);

/// The scene's terrain in the plane; empty without one.
std::optional<terrain::Rectangle> terrainArea(const scene::Scene& scene);

/// Position as given; else in the middle across its heading, with its rear at the terrain's border. Needs no bed yet.
/// Throws InputError if the vehicle is not completely on the terrain.
coupling::Placement placeVehicle(const scene::Scene& scene, const vehicle::VehicleSpec& spec);

/// Checks that the parts' meshes exist and fit vehicle.sphere_radius. Throws InputError before a bed settles; the
/// conversion to spheres checks the same, but without the place in the scene.
void checkParts(const scene::Scene& scene);

} // namespace grouser::setup
