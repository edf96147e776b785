// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "coupling/surface_setup.hpp"
#include "runs/setup/drawn_planes.hpp"

namespace grouser::output {

/// A box, cylinder, tube or capsule in its own frame; empty of a plane.
base::TriangleMesh shapeMesh(const contact::SurfaceGeometry& shape);

/// A surface as triangles in its own frame, for pictures; counter-clockwise from where grains are seen: a hollow
/// cylinder shows its inside. `endless`: a floor extends to the horizon.
base::TriangleMesh surfaceMesh(const setup::DrawnPlanes& planes, const coupling::SurfaceSetup& surface,
                               bool endless = false);

} // namespace grouser::output
