// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/part_meshes.hpp"

namespace grouser::vehicle {

/// Overlap of the hull mesh with shoes or wheels by more than a millimetre, in the drawn position. A run has no
/// contacts between hull and tracks, so it would persist. Empty if there is none.
std::optional<SpecFault> hullFault(const VehicleSpec& spec, const PartMeshes& meshes);

} // namespace grouser::vehicle
