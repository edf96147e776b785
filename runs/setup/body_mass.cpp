// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/body_mass.hpp"

#include "base/math.hpp"
#include "runs/scene/mechanism_structs.hpp"
#include "runs/support/orientation.hpp"
#include "spheredecomp/mesh.hpp"
#include "spheredecomp/mesh_query.hpp"

namespace grouser::setup {

using base::kPi;
using base::Mat3d;
using base::Vec3d;
using contact::SurfaceShape;

contact::SurfaceGeometry geometryOf(const scene::ShapeSection& s) {
  switch (s.kind) {
  case scene::ShapeKind::box:
    return {SurfaceShape::box, *s.size * 0.5};
  case scene::ShapeKind::cylinder:
    return {SurfaceShape::cylinder, {*s.radius, 0, 0.5 * *s.length}};
  case scene::ShapeKind::capsule:
    return {SurfaceShape::capsule, {*s.radius, 0, 0.5 * *s.length}};
  case scene::ShapeKind::cone:
    return {SurfaceShape::cone, {*s.radius, s.tipRadius.value_or(0), 0.5 * *s.length}};
  case scene::ShapeKind::mesh:
    if (s.loaded.box) return {SurfaceShape::box, s.loaded.box->half};
    return {SurfaceShape::box, spheredecomp::bounds(s.loaded.query->mesh()).second};
  case scene::ShapeKind::sphere:
    break;
  }
  return {SurfaceShape::capsule, {*s.radius, 0, 0}};
}

base::Pose poseOf(const scene::ShapeSection& s) {
  if (s.kind == scene::ShapeKind::box || s.kind == scene::ShapeKind::mesh) {
    const base::Quat turn = support::orientationOf(s.axis, s.angle, {});
    return {s.position + rotate(turn, s.loaded.middle), s.loaded.box ? turn * s.loaded.box->orientation : turn};
  }
  return {s.position, s.axis ? support::turnFromZ(base::normalized(*s.axis)) : base::Quat{}};
}

namespace {

/// Inertia of a solid of revolution about z, from the moments of inertia about a transverse axis and about z.
Mat3d round(double across, double along) { return Mat3d::diagonal({across, across, along}); }

/// Moments of V = pi int a^2 dz over the height; the radius a decreases linearly from R to r: I_z = pi/2 int a^4 dz,
/// I_x about the base = I_z / 2 + pi int a^2 z^2 dz.
SolidMoments momentsOfCone(double R, double r, double h) {
  const double squares = R * R + R * r + r * r, volume = kPi * h / 3 * squares;
  const double height = h / 4 * (R * R + 2 * R * r + 3 * r * r) / squares; // height of the centroid above the base
  const double along = kPi * h / 10 * (R * R * R * R + R * R * R * r + R * R * r * r + R * r * r * r + r * r * r * r);
  const double atBase = along / 2 + kPi * h * h * h * (R * R + 3 * R * r + 6 * r * r) / 30;
  return {volume, {0, 0, height - h / 2}, round(atBase - volume * height * height, along)};
}

/// Parallel-axis term of a unit mass with its centre at the distance `d` from the reference point.
Mat3d steiner(const Vec3d& d) {
  Mat3d m{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m.m[i][j] = (i == j ? norm2(d) : 0.0) - d[i] * d[j];
  return m;
}

Mat3d transposed(const Mat3d& a) {
  Mat3d t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t.m[i][j] = a.m[j][i];
  return t;
}

void add(Mat3d& to, const Mat3d& m, double factor) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) to.m[i][j] += factor * m.m[i][j];
}

} // namespace

SolidMoments momentsOf(const contact::SurfaceGeometry& g) {
  const double r = g.half.x, l = 2 * g.half.z;
  if (g.shape == SurfaceShape::box) {
    const Vec3d e = g.half * 2.0;
    const double v = e.x * e.y * e.z;
    return {v,
            {},
            Mat3d::diagonal({v / 12 * (e.y * e.y + e.z * e.z), v / 12 * (e.x * e.x + e.z * e.z),
                             v / 12 * (e.x * e.x + e.y * e.y)})};
  }
  if (g.shape == SurfaceShape::cone) return momentsOfCone(r, g.half.y, l);
  const double cylinder = kPi * r * r * l; // volume
  double volume = cylinder, across = cylinder / 12 * (3 * r * r + l * l), along = cylinder / 2 * r * r;
  if (g.shape == SurfaceShape::capsule) {
    // Two hemispheres; their centres of mass are 3/8 r beyond the ends of the cylinder.
    const double caps = 4.0 / 3 * kPi * r * r * r;
    volume += caps, along += caps * 0.4 * r * r, across += caps * (0.4 * r * r + l * l / 4 + 3.0 / 8 * l * r);
  }
  return {volume, {}, round(across, along)};
}

/// Each triangle (a, b, c) spans a tetrahedron with the origin. With D = a . (b x c) and s = a + b + c its volume is
/// D / 6, its first moment D / 24 s, its second moment int x x^T = D / 120 (s s^T + a a^T + b b^T + c c^T). The inertia
/// is tr(int x x^T) 1 - int x x^T.
SolidMoments momentsOf(const base::TriangleMesh& mesh) {
  SolidMoments all;
  Mat3d second{};
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const Vec3d &a = mesh.vertices[mesh.indices[t]], &b = mesh.vertices[mesh.indices[t + 1]],
                &c = mesh.vertices[mesh.indices[t + 2]];
    const double D = dot(a, cross(b, c));
    const Vec3d s = a + b + c;
    all.volume += D / 6, all.centre += s * (D / 24);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) second.m[i][j] += D / 120 * (s[i] * s[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
  }
  all.centre = all.centre * (1 / all.volume);
  const double trace = second.m[0][0] + second.m[1][1] + second.m[2][2];
  all.inertia = Mat3d::diagonal({trace, trace, trace});
  add(all.inertia, second, -1), add(all.inertia, steiner(all.centre), -all.volume);
  return all;
}

double massOf(const scene::BodySection& body) {
  return body.mass ? *body.mass : *body.density * momentsOf(body).volume;
}

SolidMoments momentsOf(const scene::BodySection& body) {
  SolidMoments all;
  for (const scene::ShapeSection& s : body.shapes) {
    const SolidMoments own = s.loaded.query ? momentsOf(s.loaded.query->mesh()) : momentsOf(geometryOf(s));
    const base::Pose pose = poseOf(s);
    const Vec3d centre = pose.toWorld(own.centre);
    const Mat3d R = pose.orientation.matrix();
    // R (R I)^T = R I R^T, since I is symmetric.
    add(all.inertia, R * transposed(R * own.inertia), 1), add(all.inertia, steiner(centre), own.volume);
    all.centre += centre * own.volume, all.volume += own.volume;
  }
  all.centre = all.centre * (1 / all.volume);
  add(all.inertia, steiner(all.centre), -all.volume);
  return all;
}

} // namespace grouser::setup
