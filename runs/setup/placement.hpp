// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "runs/scene/scene.hpp"
#include "terrain/height_field.hpp"
#include "vehicle/spec.hpp"

#include <functional>
#include <optional>
#include <string>

namespace grouser::setup {

/// Where a vehicle is set down.
struct Placement {
  double x{}, y{};  ///< of the middle between the sprockets [m]
  double heading{}; ///< from the x axis towards y [rad]
};

/// The vehicle file of the scene, with the scene's keys; a single track lies in the middle. Throws InputError.
vehicle::VehicleSpec vehicleSpec(const scene::Scene& scene);

/// The scene's terrain in the plane; empty without one.
std::optional<terrain::Rectangle> terrainArea(const scene::Scene& scene);

/// As the scene says; else in the middle across its heading, with its rear at the terrain's border. Needs no bed yet.
/// Throws InputError when the vehicle does not stand wholly on the terrain.
Placement placeVehicle(const scene::Scene& scene, const vehicle::VehicleSpec& spec);

/// The parts' meshes must be there and fit the scene's vehicle.sphere_radius. Throws InputError before a bed takes its
/// time; cutting them checks the same, but knows of no scene.
void checkParts(const scene::Scene& scene);

/// Where a vehicle stands when it is set down along the ground under it: pitch and roll are those of the least-squares
/// plane of the heights under both tracks, and the lowest grousers stand `clearance` [m] above the highest point,
/// square to that plane.
base::Pose setDown(const vehicle::VehicleSpec& spec, const Placement& place, double clearance,
                   const std::function<double(double, double)>& surfaceHeight);

} // namespace grouser::setup
