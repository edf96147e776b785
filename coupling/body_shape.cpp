// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/body_shape.hpp"

#include "contact/shape_points.hpp"
#include "coupling/mesh_contacts.hpp"
#include "spheredecomp/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::coupling {

using base::Vec3d;

namespace {

/// Upper bound (Gershgorin) of the largest eigenvalue of sum A n n^T over the triangles: the translational stiffness of
/// a surface on springs of unit stiffness per area [m2]. For a box it is twice the area of the largest face.
double facingArea(const base::TriangleMesh& mesh) {
  base::Mat3d sum{};
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const Vec3d &a = mesh.vertices[mesh.indices[t]], &b = mesh.vertices[mesh.indices[t + 1]],
                &c = mesh.vertices[mesh.indices[t + 2]];
    const Vec3d twice = cross(b - a, c - a);
    const double size = norm(twice);
    if (!(size > 0)) continue;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum.m[i][j] += 0.5 * twice[i] * twice[j] / size;
  }
  double most = 0;
  for (const auto& row : sum.m) most = std::max(most, std::fabs(row[0]) + std::fabs(row[1]) + std::fabs(row[2]));
  return most;
}

} // namespace

BodyMesh bodyMesh(std::shared_ptr<const spheredecomp::MeshQuery> query, double sphereRadius, bool given) {
  const base::TriangleMesh& mesh = query->mesh();
  const double thickness = spheredecomp::signedVolume(mesh) / spheredecomp::area(mesh), facing = facingArea(mesh);
  return {std::move(query), sphereRadius, given, thickness, facing};
}

double distanceFrom(const BodyShape& s, const Vec3d& p_S) {
  return s.mesh ? s.mesh->query->signedDistance(p_S) : contact::gapTo(s.shape, p_S).distance;
}

double halfThickness(const BodyShape& s) {
  const double ofBox = thinnest(s.shape);
  return s.mesh ? std::min(ofBox, s.mesh->halfThickness) : ofBox;
}

double minFeature(const BodyShape& s) {
  return s.mesh ? std::min(halfThickness(s), 2 * s.mesh->sphereRadius) : halfThickness(s);
}

double farthestAlong(const BodyShape& s, const Vec3d& d) {
  if (!s.mesh) return contact::farthestAlong(s.shape, d);
  double most = -base::kInfinity;
  for (const Vec3d& v : s.mesh->query->mesh().vertices) most = std::max(most, dot(v, d));
  return most;
}

std::vector<contact::SurfaceSample> surfacePoints(const BodyShape& s) {
  if (!s.mesh) return contact::shapePoints(s.shape);
  const spheredecomp::MeshQuery& query = *s.mesh->query;
  return contact::meshPoints(query.mesh(), std::min(s.mesh->sphereRadius, contact::meshSpacing(s.shape.half)),
                             [&query](const Vec3d& p) { return query.inside(p); });
}

bool sameSurface(const BodyShape& a, const BodyShape& b) {
  if (!a.mesh != !b.mesh || a.shape.shape != b.shape.shape || !(a.shape.half == b.shape.half)) return false;
  if (a.mesh == b.mesh) return true;
  const base::TriangleMesh &ma = a.mesh->query->mesh(), &mb = b.mesh->query->mesh();
  return a.mesh->sphereRadius == b.mesh->sphereRadius && a.mesh->sphereRadiusGiven == b.mesh->sphereRadiusGiven &&
         ma.indices == mb.indices && ma.vertices == mb.vertices;
}

std::vector<std::size_t> uniqueMeshes(const std::vector<BodyShape>& shapes) {
  std::vector<std::size_t> unique;
  for (std::size_t i = 0; i < shapes.size(); ++i)
    if (shapes[i].mesh &&
        std::none_of(unique.begin(), unique.end(), [&](std::size_t u) { return sameSurface(shapes[u], shapes[i]); }))
      unique.push_back(i);
  return unique;
}

namespace {

/// Smallest feature of all shapes that can touch a shape with this mesh [m]; at most half the diagonal of the mesh.
double smallestPartner(const BodyShape& mesh, const std::vector<BodyShape>& shapes,
                       const std::vector<multibody::Body>& bodies) {
  double smallest = norm(mesh.shape.half);
  for (const BodyShape& own : shapes) {
    if (!own.mesh || !sameSurface(own, mesh)) continue;
    for (const BodyShape& other : shapes)
      if (other.body != own.body && !(bodies[other.body].fixed && bodies[own.body].fixed))
        smallest = std::min(smallest, minFeature(other));
  }
  return smallest;
}

} // namespace

std::vector<PartCut> meshCuts(const std::vector<BodyShape>& shapes, const std::vector<multibody::Body>& bodies,
                              double contactSize) {
  std::vector<PartCut> cuts;
  for (const std::size_t i : uniqueMeshes(shapes)) {
    const BodyShape& s = shapes[i];
    const double size = std::min(contactSize, smallestPartner(s, shapes, bodies));
    SurfaceSetup surface;
    surface.name = s.key, surface.mesh = s.mesh->query;
    surface.sphereRadius = s.mesh->sphereRadius, surface.sphereRadiusGiven = s.mesh->sphereRadiusGiven;
    cuts.push_back(meshCut(surface, size));
    cuts.back().key = s.key + ".sphere_radius";
    cuts.back().place = s.place.substr(0, s.place.rfind(' ') + 1) + cuts.back().key;
  }
  return cuts;
}

} // namespace grouser::coupling
