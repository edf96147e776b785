// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/part_meshes.hpp"

namespace grouser::vehicle {

/// Returns the first mass, moment of inertia or centre of mass that is implausible for the size of the mesh: a part
/// lighter than air or heavier than any metal, a radius of gyration far above or below the extent, or a hull centre of
/// mass far outside the hull. Empty if all values are plausible.
std::optional<SpecFault> massFault(const VehicleSpec& spec, const PartMeshes& meshes);

} // namespace grouser::vehicle
