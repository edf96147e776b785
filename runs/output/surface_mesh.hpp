// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "coupling/surface_setup.hpp"
#include "runs/setup/drawn_planes.hpp"

namespace grouser::output {

/// Mesh of a box, cylinder, tube or capsule in its own frame; empty for a plane.
base::TriangleMesh shapeMesh(const contact::SurfaceGeometry& shape);

/// A surface as triangles in its own frame, for pictures; counter-clockwise as seen from the side of the grains: a
/// hollow cylinder shows its inside. `endless`: floors extend to the horizon.
base::TriangleMesh surfaceMesh(const setup::DrawnPlanes& planes, const coupling::SurfaceSetup& surface,
                               bool endless = false);

} // namespace grouser::output
