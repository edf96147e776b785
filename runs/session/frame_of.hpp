// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "runs/output/records.hpp"
#include "terrain/grains.hpp"
#include "terrain/height_field.hpp"

namespace grouser::fluid {
class Fluid;
}

namespace grouser::session {

/// Triangles of the rigid surface, for pictures.
base::TriangleMesh groundMesh(const terrain::HeightField& field);

/// Puts the grains of this rank into the frame. `contactForces`: whether frames have contact forces; `known`: whether a
/// step has computed them (otherwise NaN).
void addGrains(output::Frame& frame, const terrain::Grains& grains, bool contactForces, bool known);

/// All particles of a fluid.
std::shared_ptr<const output::FluidPoints> fluidPoints(const fluid::Fluid& fluid);

} // namespace grouser::session
