// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/vehicle_shape.hpp"
#include "scm/soil_constants.hpp"

/// Limits of a vehicle on deformable soil, modelled as two rigid tracks with uniform pressure, by the relations of
/// Bekker and Janosi.
namespace grouser::events {

/// Tangent of the steepest slope on which shear stress can support the vehicle [-]: W sin a = c A + W cos a tan phi;
/// infinite if there is no such limit.
double holdingSlope(const VehicleShape& shape, const scm::SoilConstants& soil);

/// F(i) = (c A + W tan phi) (1 - K / (i L) (1 - exp(-i L / K))) at a slip i in (0, 1] [N].
double trackThrust(const VehicleShape& shape, const scm::SoilConstants& soil, double slip);

/// R_c of both tracks: the work of compaction per distance, 2 b k z^(n+1) / (n+1) at the sinkage z under W / A [N].
double compactionResistance(const VehicleShape& shape, const scm::SoilConstants& soil);

} // namespace grouser::events
