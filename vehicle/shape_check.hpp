// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/part_meshes.hpp"

#include <optional>

namespace grouser::vehicle {

/// Returns the first inconsistency of the shapes with each other, the spec or the meshes. The tolerance is
/// min(1 mm, pitch / 100). Empty if the spec has no shapes.
std::optional<SpecFault> shapeFault(const VehicleSpec& spec, const PartMeshes& meshes);

} // namespace grouser::vehicle
