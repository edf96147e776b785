// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "contact/part_surface.hpp"
#include "contact/surface_geometry.hpp"

#include <functional>
#include <vector>

namespace grouser::contact {

/// Surface points of a closed-form solid (box, cylinder, cone, capsule) in its own frame, each with its share of the
/// area [m2]. The spacing is relative to the size of the shape: about 1/24 of the longest edge of a box, at most
/// 1/80 of a turn on round shapes. Edges of boxes and cylinders have points of both adjacent faces, inset by 0.5 % of
/// half the face.
std::vector<SurfaceSample> shapePoints(const SurfaceGeometry& shape);

/// Maximum point spacing of a mesh [m]: 1/40 of the diagonal of its bounding box. `half`: half edges of the box [m].
inline double meshSpacing(const base::Vec3d& half) { return norm(half) / 20; }

/// Surface points of a mesh in its own frame, each with its share of the area [m2]: corners of triangles with edges up
/// to `spacing` [m], moved by 0.5 % towards the centre of their face. Skips points whose outer side is inside the mesh
/// (`isInside`): hidden faces of overlapping shells.
std::vector<SurfaceSample> meshPoints(const base::TriangleMesh& mesh, double spacing,
                                      const std::function<bool(const base::Vec3d&)>& isInside);

} // namespace grouser::contact
