// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/part_meshes.hpp"

namespace grouser::vehicle {

/// Implausible masses and moments of inertia for the mesh sizes: lighter than air or heavier than any metal, or a
/// radius of gyration far beyond or below the extent. Empty if plausible.
std::optional<SpecFault> massFault(const VehicleSpec& spec, const PartMeshes& meshes);

} // namespace grouser::vehicle
