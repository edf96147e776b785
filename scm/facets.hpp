// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "contact/surface_geometry.hpp"

#include <vector>

namespace grouser::scm {

using base::Vec3d;

/// Plane convex polygon of a body's surface, in the frame of its part.
struct Facet {
  std::vector<Vec3d> corners; ///< [m], along the edge, in either direction
  Vec3d normal;               ///< unit, out of the body
};

/// Surface of a rigid body, or of one of several shapes of a body.
struct Solid {
  int part{};     ///< index of its part
  int body{};     ///< solids of one body are adjacent in a list and move together
  Vec3d half;     ///< half size of its bounding box, centred at the origin of the part's frame [m]
  bool isRound{}; ///< true: body of revolution about the z axis
  bool isBall{};  ///< true: sphere, with a round contact area in every orientation
  bool isConvex = true;
  std::vector<Facet> facets{}; ///< closed surface
};

/// Solid of a closed shape, other than a plane. A box is exact. Round shapes have polygons of equal area for sections
/// across the axis, with sides shorter than half the `spacing` of the nodes [m] or 1/48 of the perimeter.
Solid solidOf(const contact::SurfaceGeometry& shape, double spacing, int part = 0, int body = 0);

} // namespace grouser::scm
