// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground_fields.hpp"
#include "runs/output/records.hpp"
#include "terrain/height_field.hpp"

namespace grouser::output {

/// Deformable soil as triangles with values at the vertices: at node spacing where the soil has been loaded or moved;
/// elsewhere in cells that grow with the distance from this area. The triangles cover the terrain without gaps; their
/// number depends on the touched area, not on the size of the terrain.
SoilSurface soilSurface(const coupling::GroundFields& fields, const terrain::HeightField& undisturbed);

} // namespace grouser::output
