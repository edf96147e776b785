// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/part_meshes.hpp"

namespace grouser::vehicle {

/// Returns an overlap of more than 1 mm between the hull mesh and shoes or wheels in the design position; empty if
/// there is none. Without contacts between hull and tracks, an overlap would persist during the run.
std::optional<SpecFault> hullFault(const VehicleSpec& spec, const PartMeshes& meshes);

} // namespace grouser::vehicle
