// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground_fields.hpp"
#include "runs/output/records.hpp"
#include "terrain/height_field.hpp"

namespace grouser::output {

/// Deformable soil as triangles with values at their vertices: at node spacing where soil has been loaded or moved, and
/// in cells that grow with the distance from there elsewhere. The triangles cover the terrain without gaps, so that
/// their number grows with the touched ground and not with the terrain.
SoilSurface soilSurface(const coupling::GroundFields& fields, const terrain::HeightField& undisturbed);

} // namespace grouser::output
