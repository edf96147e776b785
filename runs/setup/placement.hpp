// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/vehicle_setup.hpp"
#include "terrain/height_field.hpp"

#include <optional>

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// The vehicle of the scene: its vehicle file with overrides of [spec]; a single track is in the middle. Throws
/// InputError.
vehicle::VehicleSpec vehicleSpec(const scene::Scene& scene);

/// Horizontal extent of the scene's terrain; empty without terrain.
std::optional<terrain::Rectangle> terrainArea(const scene::Scene& scene);

/// Position as given, otherwise centred across the heading with the rear at the terrain's border. Does not require the
/// bed. Throws InputError if the vehicle is not completely on the terrain.
coupling::Placement placeVehicle(const scene::Scene& scene, const vehicle::VehicleSpec& spec);

/// Checks that the parts' meshes exist and are compatible with vehicle.sphere_radius. Throws InputError before a bed
/// settles; the later conversion to spheres makes the same checks, but without the place in the scene.
void checkParts(const scene::Scene& scene);

/// Throws InputError if the vehicle file lacks a section that the scene requires: [engine], [shapes].
void checkSections(const scene::Scene& scene, const vehicle::VehicleSpec& spec);

} // namespace grouser::setup
