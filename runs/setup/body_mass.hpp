// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "base/vec.hpp"
#include "contact/surface_geometry.hpp"
#include "spheredecomp/mesh_query.hpp"

namespace grouser::scene {
struct BodySection;
struct ShapeSection;
} // namespace grouser::scene

namespace grouser::setup {

/// A shape of a [[body]] as contacts see it, of a mesh the box that holds it, and where its frame S stands in the
/// body's: X_BS.
contact::SurfaceGeometry geometryOf(const scene::ShapeSection& shape);
base::Pose poseOf(const scene::ShapeSection& shape);

/// Volume and second moments of a solid.
struct SolidMoments {
  double volume{};     ///< [m3]
  base::Vec3d centre;  ///< centroid [m]
  base::Mat3d inertia; ///< about the centroid at unit density [m5]
};

/// Closed forms of a homogeneous box, cylinder, capsule (sphere) or cone, in its own frame.
SolidMoments momentsOf(const contact::SurfaceGeometry& shape);

/// Exact sums over the tetrahedra between the triangles of a closed mesh and the origin.
SolidMoments momentsOf(const base::TriangleMesh& mesh);

/// Mass of a body that moves: given, or of its shapes [kg].
double massOf(const scene::BodySection& body);

/// Returns true if shells of a closed mesh overlap or nest, so that momentsOf() counts their common volume twice.
bool shellsOverlap(const spheredecomp::MeshQuery& mesh);

/// All shapes of a body in its frame, about their common centre (Huygens-Steiner). Where shapes overlap, the overlap
/// counts for each.
SolidMoments momentsOf(const scene::BodySection& body);

} // namespace grouser::setup
