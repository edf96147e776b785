// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "base/vec.hpp"
#include "contact/surface_geometry.hpp"

namespace grouser::scene {
struct BodySection;
struct ShapeSection;
} // namespace grouser::scene

namespace grouser::setup {

/// Geometry of a shape of a [[body]] (mesh: the box that it is, else its bounding box), and pose X_BS of the shape's
/// frame S in the body's frame.
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

/// Exact moments of the solid inside a closed mesh.
SolidMoments momentsOf(const base::TriangleMesh& mesh);

/// Mass of a moving body [kg]: the key `mass`, or density times the volume of its shapes.
double massOf(const scene::BodySection& body);

/// All shapes of a body in its frame, about their common centre (Huygens-Steiner). The common volume of overlapping
/// shapes counts for each shape.
SolidMoments momentsOf(const scene::BodySection& body);

} // namespace grouser::setup
