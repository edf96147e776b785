// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/part_meshes.hpp"

namespace grouser::vehicle {

/// A hull that stands in its tracks, as both are drawn: shoes or wheels that its mesh overlaps by more than a
/// millimetre. Nothing would push them apart, since a run has no contacts between the two. Empty where they are clear.
std::optional<SpecFault> hullFault(const VehicleSpec& spec, const PartMeshes& meshes);

} // namespace grouser::vehicle
