// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "vehicle/running_gear.hpp"
#include "vehicle/spec.hpp"

#include <optional>

namespace grouser::vehicle {

/// Meshes of a vehicle, one per kind of part; the roller mesh is empty without rollers.
struct PartMeshes {
  base::TriangleMesh chassis{}, shoe{}, sprocket{}, roadWheel{}, roller{}, idler{};
};

/// Difference between mesh and spec dimensions: parts placed by one and in contact by the other would overlap or have
/// gaps at the start. Also teeth that do not fit the pins, horns that reach into a wheel's hub, and a hull that reaches
/// below the tracks. Empty if the meshes fit to a millimetre.
std::optional<SpecFault> meshFault(const VehicleSpec& spec, const PartMeshes& meshes);

} // namespace grouser::vehicle
