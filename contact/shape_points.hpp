// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "contact/part_surface.hpp"
#include "contact/surface_geometry.hpp"

#include <functional>
#include <vector>

namespace grouser::contact {

/// Surface points of a closed-form solid (box, cylinder, cone, capsule) in its own frame, each with its share of the
/// area [m2]. The spacing is a share of the shape's size: about 1/24 of the longest edge of a box, 1/80 of a turn or
/// finer where the shape is round. Edges of boxes and cylinders have points of both faces that meet there, 0.5 % of
/// half the face within it.
std::vector<SurfaceSample> shapePoints(const SurfaceGeometry& shape);

/// Surface points of a mesh in its own frame, each with its share of the area [m2]: corners of triangles no longer than
/// `spacing` [m], 0.5 % of the way to the middle of their face. Those just outside of which `isInside` is true are left
/// out: faces of overlapping shells within each other.
std::vector<SurfaceSample> meshPoints(const base::TriangleMesh& mesh, double spacing,
                                      const std::function<bool(const base::Vec3d&)>& isInside);

} // namespace grouser::contact
