// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/part_meshes.hpp"

namespace grouser::vehicle {

/// Masses and moments of inertia that no body of the meshes' size has: lighter than air or heavier than any metal, or
/// turning as if much larger or much smaller than it is. Empty for those that may be.
std::optional<SpecFault> massFault(const VehicleSpec& spec, const PartMeshes& meshes);

} // namespace grouser::vehicle
