// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/surface_mesh.hpp"

#include "base/math.hpp"
#include "runs/output/plane_mesh.hpp"

#include <algorithm>

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

/// `tip`: radius of the upper end. `radius`: radius of the lower end.
TriangleMesh roundMesh(double radius, double tip, double half, bool hollow) {
  constexpr int kSides = 64;
  TriangleMesh mesh;
  std::vector<Vec3d> top, bottom;
  for (int k = 0; k < kSides; ++k) {
    const double angle = 2 * base::kPi * k / kSides, x = base::cos(angle), y = base::sin(angle);
    top.push_back({tip * x, tip * y, half});
    bottom.push_back({radius * x, radius * y, -half});
  }
  for (std::size_t k = 0; k < kSides; ++k) {
    const std::size_t next = (k + 1) % kSides;
    const Vec3d a = top[k], b = top[next], c = bottom[next], d = bottom[k];
    addFace(mesh, hollow ? std::vector{a, b, c, d} : std::vector{a, d, c, b});
  }
  if (hollow) return mesh;
  std::reverse(bottom.begin(), bottom.end());
  addFace(mesh, top), addFace(mesh, bottom);
  return mesh;
}

/// Circles of latitude of a sphere, with the two halves moved apart along z by the length of the segment.
TriangleMesh capsuleMesh(double radius, double half) {
  constexpr int kSides = 48, kRings = 12; // each cap has kRings rings
  TriangleMesh mesh;
  const auto place = [&](int ring, int side) {
    const double up = base::kPi * (0.5 - static_cast<double>(ring) / (2 * kRings)),
                 angle = 2 * base::kPi * side / kSides;
    const double across = radius * base::cos(up), z = radius * base::sin(up);
    return Vec3d{across * base::cos(angle), across * base::sin(angle), z + (ring <= kRings ? half : -half)};
  };
  for (int ring = 0; ring < 2 * kRings; ++ring)
    for (int side = 0; side < kSides; ++side) {
      const int belt = ring == kRings ? 1 : 0; // between the caps
      const Vec3d a = place(ring, side), b = place(ring, side + 1), c = place(ring + 1, side),
                  d = place(ring + 1, side + 1);
      if (belt && half > 0) {
        const Vec3d down{0, 0, -2 * half};
        addFace(mesh, {a, a + down, b + down, b});
        addFace(mesh, {a + down, c, d, b + down});
      } else {
        addFace(mesh, {a, c, d, b});
      }
    }
  return mesh;
}

} // namespace

TriangleMesh shapeMesh(const contact::SurfaceGeometry& shape) {
  switch (shape.shape) {
  case SurfaceShape::box:
    return boxMesh(shape.half);
  case SurfaceShape::cylinder:
  case SurfaceShape::tube:
    return roundMesh(shape.half.x, shape.half.x, shape.half.z, shape.shape == SurfaceShape::tube);
  case SurfaceShape::cone:
    return roundMesh(shape.half.x, shape.half.y, shape.half.z, false);
  case SurfaceShape::capsule:
    return capsuleMesh(shape.half.x, shape.half.z);
  case SurfaceShape::plane:
    break;
  }
  return {};
}

TriangleMesh surfaceMesh(const setup::DrawnPlanes& planes, const coupling::SurfaceSetup& surface, bool endless) {
  if (surface.mesh) return surface.mesh->mesh();
  if (surface.geometry.shape != SurfaceShape::plane) return shapeMesh(surface.geometry);
  TriangleMesh mesh = endless ? floorMesh(planes, surface.number) : planeMesh(planes, surface.number);
  for (Vec3d& v : mesh.vertices) {
    v = surface.start.toBody(v);
    if (surface.aboveBed) v.z = 0; // its height was unknown when the mesh was created
  }
  return mesh;
}

} // namespace grouser::output
