// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"

#include <string>
#include <utility>

namespace grouser::spheredecomp {

using base::TriangleMesh;
using base::Vec3d;

/// Reads a mesh by assimp (OBJ, STL, PLY, glTF, ... any format it knows), cuts faces of more than three corners into
/// triangles and welds vertices of equal position; where that leaves it open, also those at open edges that differ by
/// rounding, see weldOpenEdges. Several closed shells may overlap or touch: inside is where the winding number is not
/// zero.
/// @param path  file; coordinates in metres
/// @param note receives a note on welded vertices that differ; may be null Throws base::InputError: no such file,
/// unknown format, no triangles, a face that crosses itself, not watertight, inside out.
TriangleMesh importMesh(const std::string& path, std::string* note = nullptr);

/// Throws base::InputError, naming `name` and an open edge, unless every directed edge has its opposite, all
/// coordinates are finite and the signed volume is positive.
void checkClosed(const TriangleMesh& mesh, const std::string& name);

/// Merges vertices of exactly equal position and drops triangles that this makes degenerate.
TriangleMesh weld(const TriangleMesh& mesh);

/// Merges vertices of open edges within `tolerance` [m] of each other, which differ by rounding in files written by
/// several programs. Merges nothing if two of them share an edge, since a thin part would collapse. Returns the number
/// of removed vertices.
std::size_t weldOpenEdges(TriangleMesh& mesh, double tolerance);

/// Enclosed volume by the divergence theorem [m3]; where shells overlap, the common part counts as often as it is
/// covered.
double signedVolume(const TriangleMesh& mesh);

/// Sum of all triangle areas [m2].
double area(const TriangleMesh& mesh);

/// Lower and upper corner of the bounding box [m].
std::pair<Vec3d, Vec3d> bounds(const TriangleMesh& mesh);

} // namespace grouser::spheredecomp
