// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "vehicle/running_gear.hpp"
#include "vehicle/spec.hpp"

#include <optional>
#include <string>

namespace grouser::vehicle {

/// Meshes of a vehicle, one per kind of part; the roller mesh is empty without rollers.
struct PartMeshes {
  base::TriangleMesh chassis{}, shoe{}, sprocket{}, roadWheel{}, roller{}, idler{};
};

/// Returns the first difference between the dimensions of mesh and spec that would cause initial overlaps or gaps, e.g.
/// teeth that do not fit the pins, horns that reach a wheel's hub, or a hull that reaches below the tracks. Empty if
/// the dimensions agree within 1 mm.
std::optional<SpecFault> meshFault(const VehicleSpec& spec, const PartMeshes& meshes);

/// A fault if the mesh of a section ("shoe", "chassis") is larger than the spec by the factor between metres and
/// another unit, e.g. 1000 for millimetres.
std::optional<SpecFault> unitFault(const std::string& section, const VehicleSpec& spec, const base::TriangleMesh& mesh);

} // namespace grouser::vehicle
