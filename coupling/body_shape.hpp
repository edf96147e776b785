// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "contact/part_surface.hpp"
#include "contact/surface_geometry.hpp"
#include "coupling/sphere_sets.hpp"
#include "multibody/model.hpp"
#include "spheredecomp/mesh_query.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace grouser::coupling {

/// A closed mesh with its bounding box centred at the origin.
struct BodyMesh {
  std::shared_ptr<const spheredecomp::MeshQuery> query;
  double sphereRadius{};    ///< radius of the spheres that represent the mesh in grain contacts [m]
  bool sphereRadiusGiven{}; ///< true: radius set in the scene; false: the sphere cut may use a smaller radius
  double halfThickness{};   ///< mean half thickness: volume / area [m]
  double facingArea{};      ///< largest projected area, front plus back [m2]
};

/// Contact surface of a body for grains, rigid surfaces and other bodies.
struct BodyShape {
  std::size_t body{};                     ///< index into the model's bodies
  base::Pose pose_B;                      ///< pose of the shape frame in the body frame
  contact::SurfaceGeometry shape;         ///< closed-form surface, or the bounding box of a mesh
  int material{};                         ///< index of its material in the list for all shapes
  double largestOverlap{base::kInfinity}; ///< limit of overlaps with surfaces and other bodies [m]
  std::string place;                      ///< prefix of messages: "scene.toml:14: body.0"
  std::string key{};                      ///< section of a mesh in messages: "body.0.shape.0"
  std::shared_ptr<const BodyMesh> mesh{}; ///< null for closed-form shapes
};

/// Creates a body mesh. `query`: closed mesh, bounding box centred at the origin; `given`: radius set in the scene.
BodyMesh bodyMesh(std::shared_ptr<const spheredecomp::MeshQuery> query, double sphereRadius, bool given);

/// Default limit of overlaps [half thickness].
inline constexpr double kLargestOverlap = 0.5;

/// Distance of a point from the surface, in the shape's frame [m]; negative inside.
double distanceFrom(const BodyShape& shape, const base::Vec3d& p_S);
/// Minimum half thickness of a shape, at most half the mean thickness of a mesh [m].
double halfThickness(const BodyShape& shape);
/// Minimum contact feature [m]: the half thickness; for a mesh, at most its sphere diameter. A shape that moves by more
/// than half this length in one step could pass through another shape.
double minFeature(const BodyShape& shape);
/// Support function: largest p . d over the surface points p [m], for a unit vector d in the shape's frame.
double farthestAlong(const BodyShape& shape, const base::Vec3d& d);
/// Sample points for contact with rigid surfaces.
std::vector<contact::SurfaceSample> surfacePoints(const BodyShape& shape);
/// True if two shapes have the same surface and sphere radius.
bool sameSurface(const BodyShape& a, const BodyShape& b);

/// Indices of the shapes with distinct meshes. Shapes with equal meshes share one sphere set.
std::vector<std::size_t> uniqueMeshes(const std::vector<BodyShape>& shapes);
/// Sphere cuts of the distinct meshes, for contact with grains and vehicle parts of at least `contactSize` [m]
/// (infinite: none), and with the shapes of other bodies. The thickness of a mesh itself does not limit its spheres.
std::vector<PartCut> meshCuts(const std::vector<BodyShape>& shapes, const std::vector<multibody::Body>& bodies,
                              double contactSize);

} // namespace grouser::coupling
