// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/surface_mesh.hpp"

#include "base/math.hpp"
#include "runs/output/plane_mesh.hpp"

namespace grouser::output {

using base::TriangleMesh;
using base::Vec3d;
using terrain::SurfaceShape;

namespace {

void addFace(TriangleMesh& mesh, const std::vector<Vec3d>& polygon) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), polygon.begin(), polygon.end());
  for (std::uint32_t k = 2; k < polygon.size(); ++k)
    for (const std::uint32_t v : {0u, k - 1, k}) mesh.indices.push_back(first + v);
}

TriangleMesh boxMesh(const Vec3d& half) {
  TriangleMesh mesh;
  for (int a = 0; a < 3; ++a)
    for (const double side : {-1.0, 1.0}) {
      std::vector<Vec3d> face;
      for (int k = 0; k < 4; ++k) {
        Vec3d p;
        p[a] = side * half[a];
        p[(a + 1) % 3] = (k == 1 || k == 2 ? side : -side) * half[(a + 1) % 3];
        p[(a + 2) % 3] = (k >= 2 ? 1.0 : -1.0) * half[(a + 2) % 3];
        face.push_back(p);
      }
      addFace(mesh, face);
    }
  return mesh;
}

TriangleMesh roundMesh(double radius, double half, bool hollow) {
  constexpr int kSides = 64;
  TriangleMesh mesh;
  std::vector<Vec3d> top, bottom;
  for (int k = 0; k < kSides; ++k) {
    const double angle = 2 * base::kPi * k / kSides, x = radius * base::cos(angle), y = radius * base::sin(angle);
    top.push_back({x, y, half});
    bottom.insert(bottom.begin(), {x, y, -half});
  }
  for (std::size_t k = 0; k < kSides; ++k) {
    const Vec3d a = top[k], b = top[(k + 1) % kSides], down{0, 0, -2 * half};
    addFace(mesh, hollow ? std::vector{a, b, b + down, a + down} : std::vector{a, a + down, b + down, b});
  }
  if (!hollow) addFace(mesh, top), addFace(mesh, bottom);
  return mesh;
}

} // namespace

TriangleMesh surfaceMesh(const setup::DrawnPlanes& planes, const coupling::SurfaceSetup& surface, bool endless) {
  if (surface.mesh) return surface.mesh->mesh();
  const Vec3d& half = surface.geometry.half;
  switch (surface.geometry.shape) {
  case SurfaceShape::box:
    return boxMesh(half);
  case SurfaceShape::cylinder:
  case SurfaceShape::tube:
    return roundMesh(half.x, half.z, surface.geometry.shape == SurfaceShape::tube);
  case SurfaceShape::plane:
    break;
  }
  TriangleMesh mesh = endless ? floorMesh(planes, surface.number) : planeMesh(planes, surface.number);
  for (Vec3d& v : mesh.vertices) {
    v = surface.start.toBody(v);
    if (surface.aboveBed) v.z = 0; // where it was drawn nobody knew its height
  }
  return mesh;
}

} // namespace grouser::output
