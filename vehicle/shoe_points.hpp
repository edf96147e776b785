// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/part_surface.hpp"
#include "vehicle/spec.hpp"

#include <vector>

namespace grouser::vehicle {

/// Returns surface points of a shoe from its shapes, in the shoe frame: one per cell of at most `spacing` [m] on pad,
/// grousers, plates, horn and bosses. Each point is a ball tangent to the surface from inside. `spec` must have shapes.
std::vector<contact::SurfaceSample> shoePoints(const VehicleSpec& spec, double spacing);

} // namespace grouser::vehicle
