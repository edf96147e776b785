// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "contact/part_surface.hpp"
#include "contact/surface_geometry.hpp"
#include "coupling/sphere_sets.hpp"
#include "spheredecomp/mesh_query.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace grouser::coupling {

/// A closed mesh about the middle of the box that holds it.
struct BodyMesh {
  std::shared_ptr<const spheredecomp::MeshQuery> query;
  double sphereRadius{};    ///< of the spheres it is cut into [m]
  bool sphereRadiusGiven{}; ///< by the scene; otherwise it may become finer
  double halfThickness{};   ///< mean: volume over area [m]
  double facingArea{};      ///< largest area that resists a shift, front and back [m2]
};

/// A surface by which a body touches grains, rigid surfaces and other bodies.
struct BodyShape {
  std::size_t body{};                     ///< index into the model's bodies
  base::Pose pose_B;                      ///< pose of the shape's frame in the body's frame
  contact::SurfaceGeometry shape;         ///< closed-form surface; of a mesh the box that holds it
  int material{};                         ///< index of its material among those of all shapes
  std::string place;                      ///< place of its body in messages: "scene.toml:14: body.0"
  std::string key{};                      ///< of a mesh: its section in messages: "body.0.shape.0"
  std::shared_ptr<const BodyMesh> mesh{}; ///< null but for meshes
};

/// Throws nothing; the mesh is closed and its box is centred at the origin.
BodyMesh bodyMesh(std::shared_ptr<const spheredecomp::MeshQuery> query, double sphereRadius, bool given);

/// Distance of a point from the surface, in the shape's frame [m]; negative inside.
double distanceFrom(const BodyShape& shape, const base::Vec3d& p_S);
/// Half of the thickness of a shape where it is thinnest; of a mesh no more than half of its mean thickness [m].
double halfThickness(const BodyShape& shape);
/// The smallest feature by which it touches [m]: that, or the diameter of a mesh's spheres. What moves more than half
/// of it in a step could pass.
double leastFeature(const BodyShape& shape);
/// Largest p . d over the points p of the surface [m], for a unit vector d in its frame.
double farthestAlong(const BodyShape& shape, const base::Vec3d& d);
/// Points by which it touches what is rigid.
std::vector<contact::SurfaceSample> surfacePoints(const BodyShape& shape);
/// Returns true if two shapes have the same surface, and the same spheres.
bool sameSurface(const BodyShape& a, const BodyShape& b);

/// The first shape of each mesh, by index; shapes of equal meshes share their spheres.
std::vector<std::size_t> uniqueMeshes(const std::vector<BodyShape>& shapes);
/// How these are cut for contact with what is `contactSize` [m] and larger.
std::vector<PartCut> meshCuts(const std::vector<BodyShape>& shapes, double contactSize);

} // namespace grouser::coupling
