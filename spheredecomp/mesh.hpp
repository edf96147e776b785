// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"

#include <string>
#include <utility>

namespace grouser::spheredecomp {

using base::TriangleMesh;
using base::Vec3d;

/// Reads a mesh by assimp (OBJ, STL, PLY, glTF and its other formats), triangulates polygons and welds vertices of
/// equal position. If the mesh is then still open, also welds vertices at open edges that differ by rounding; see
/// weldOpenEdges. Several closed shells may overlap or touch: a point is inside if the winding number is nonzero.
/// Throws base::InputError: no such file, unknown format, no triangles, a face that crosses itself, not watertight,
/// inside out.
/// @param path  file; coordinates in metres
/// @param note  receives a note on welded vertices that differ; may be null
TriangleMesh importMesh(const std::string& path, std::string* note = nullptr);

/// Checks that every directed edge has an opposite edge, all coordinates are finite and the signed volume is positive.
/// Otherwise throws base::InputError with `name` and an open edge.
void checkClosed(const TriangleMesh& mesh, const std::string& name);

/// Merges vertices of exactly equal position and drops triangles that become degenerate.
TriangleMesh weld(const TriangleMesh& mesh);

/// Merges vertices of open edges within `tolerance` [m] of each other, which some programs write with rounding
/// differences. Merges nothing if two such vertices share an edge, since a thin part would collapse. Returns the
/// number of removed vertices.
std::size_t weldOpenEdges(TriangleMesh& mesh, double tolerance);

/// Enclosed volume by the divergence theorem [m3], positive for outward orientation; overlaps of shells count once for
/// each shell.
double signedVolume(const TriangleMesh& mesh);

/// Sum of all triangle areas [m2].
double area(const TriangleMesh& mesh);

/// Lower and upper corners of the bounding box [m].
std::pair<Vec3d, Vec3d> bounds(const TriangleMesh& mesh);

} // namespace grouser::spheredecomp
