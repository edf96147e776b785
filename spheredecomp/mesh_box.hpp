// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "base/vec.hpp"

#include <optional>

namespace grouser::spheredecomp {

/// A solid box in the frame of a mesh.
struct MeshBox {
  base::Vec3d centre;     ///< [m]
  base::Vec3d half;       ///< half edges along the axes of the box [m]
  base::Quat orientation; ///< box to mesh; identity if the edges are parallel to the axes of the mesh
};

/// Returns the box that a closed mesh bounds, if it is a box in any orientation, with any triangulation of its faces.
/// Vertices may deviate by the rounding of single precision or of six digits. Triangles that all lie on the faces of a
/// box, without open edges, enclose its inside equally often everywhere, so their volume tells whether it is once.
std::optional<MeshBox> exactBox(const base::TriangleMesh& mesh);

} // namespace grouser::spheredecomp
