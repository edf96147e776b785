// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "vehicle/running_gear.hpp"
#include "vehicle/spec.hpp"

#include <optional>

namespace grouser::vehicle {

/// Meshes of a vehicle, one a kind of part; that of the rollers is empty where there are none.
struct PartMeshes {
  base::TriangleMesh chassis{}, shoe{}, sprocket{}, roadWheel{}, roller{}, idler{};
};

/// Where a mesh has other lengths than the spec says: what is placed by one and touches by the other overlaps or hangs
/// free at the start. Also teeth that do not take the pins, horns that reach into a wheel's hub and a hull that reaches
/// below the tracks. Empty for meshes that fit, to a millimetre.
std::optional<SpecFault> meshFault(const VehicleSpec& spec, const PartMeshes& meshes);

} // namespace grouser::vehicle
