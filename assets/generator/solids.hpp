// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"

#include <utility>
#include <vector>

/// Closed shells from which all parts are built.
namespace grouser::assets {

using base::TriangleMesh;
using base::Vec3d;
using Ring = std::vector<Vec3d>;

/// Appends the shell that joins `rings` one to the next and closes both ends by fans about the two cap centres. The
/// rings have equal counts and run counter-clockwise seen from the start; caps must be star-shaped about their centres.
void loft(TriangleMesh& mesh, const std::vector<Ring>& rings, const Vec3d& startCentre, const Vec3d& endCentre);

/// Appends a prism from y0 to y1 over a convex polygon in the x-z plane, counter-clockwise with x to the right and z
/// up.
void prism(TriangleMesh& mesh, const std::vector<std::pair<double, double>>& polygon_xz, double y0, double y1);

/// Appends an axis-parallel box.
void box(TriangleMesh& mesh, const Vec3d& low, const Vec3d& high);

/// Circle about the line parallel to y through (x, z), first vertex on the +x side, running towards +z.
/// `radius` is the mean radius of the polygon; the vertices are slightly further out.
Ring circle(double x, double y, double z, double radius, int facets);

/// Appends a body of revolution: `profile`, pairs (y, mean radius) with ascending or equal y, rotated about the line
/// parallel to y through (x, z). Both ends are closed by flat caps.
void lathe(TriangleMesh& mesh, const std::vector<std::pair<double, double>>& profile, double x, double z, int facets);

} // namespace grouser::assets
