// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/fluid_bodies.hpp"

#include "base/math.hpp"
#include "runs/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::setup {

using base::Vec3d;
using contact::SurfaceShape;

namespace {

/// Middles of n equal parts of [-half, half], about a spacing each.
std::vector<double> partsOf(double half, double spacing) {
  const auto n = std::max(1, static_cast<int>(std::lround(2 * half / spacing)));
  std::vector<double> middles;
  for (int k = 0; k < n; ++k) middles.push_back(half * (2 * (k + 0.5) / n - 1));
  return middles;
}

std::vector<Vec3d> boxPoints(const Vec3d& half, double spacing, int flat) {
  std::vector<double> along[3];
  for (int a = 0; a < 3; ++a) along[a] = a == flat ? std::vector<double>{0} : partsOf(half[a], spacing);
  std::vector<Vec3d> points;
  for (const double x : along[0])
    for (const double y : along[1])
      for (const double z : along[2]) points.push_back({x, y, z});
  return points;
}

/// Points on circles about the z axis, a spacing apart from the wall inwards and around.
std::vector<Vec3d> discPoints(double radius, double spacing) {
  std::vector<Vec3d> points;
  for (double r = radius - 0.5 * spacing; r > 0.25 * spacing; r -= spacing) {
    const auto n = std::max(3, static_cast<int>(std::lround(2 * base::kPi * r / spacing)));
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * base::kPi * (k + 0.5) / n;
      points.push_back({r * base::cos(angle), r * base::sin(angle), 0});
    }
  }
  return points;
}

std::vector<Vec3d> cylinderPoints(const Vec3d& half, double spacing, int flat) {
  std::vector<Vec3d> points;
  const std::vector<Vec3d> disc = discPoints(half.x, spacing);
  for (const double z : flat == 2 ? std::vector<double>{0} : partsOf(half.z, spacing))
    for (const Vec3d& p : disc) points.push_back({p.x, p.y, z});
  return points;
}

/// Points of spheres, each on a spiral of equal areas.
std::vector<Vec3d> spherePoints(double radius, double spacing) {
  const double turn = base::kPi * (3 - std::sqrt(5.0)); // golden angle
  std::vector<Vec3d> points;
  for (double r = radius - 0.5 * spacing; r > 0.25 * spacing; r -= spacing) {
    const auto n = std::max(4, static_cast<int>(std::lround(4 * base::kPi * r * r / (spacing * spacing))));
    for (int k = 0; k < n; ++k) {
      const double z = 1 - (2 * k + 1.0) / n, rho = std::sqrt(1 - z * z), angle = turn * k;
      points.push_back({r * rho * base::cos(angle), r * rho * base::sin(angle), r * z});
    }
  }
  return points;
}

std::vector<Vec3d> pointsOf(const coupling::BodyShape& s, double spacing, int flat) {
  if (!s.mesh) {
    if (s.shape.shape == SurfaceShape::box) return boxPoints(s.shape.half, spacing, flat);
    if (s.shape.shape == SurfaceShape::cylinder) return cylinderPoints(s.shape.half, spacing, flat);
    if (s.shape.shape == SurfaceShape::capsule && s.shape.half.z == 0) return spherePoints(s.shape.half.x, spacing);
  }
  return boxPoints(halfExtent(s.shape), spacing, flat);
}

/// Axis of the shape's frame that lies along y, in which the plane of a fluid in two dimensions has no extent.
int axisAcross(const scene::Scene& scene, const coupling::MechanismSetup& mechanism, const coupling::BodyShape& s) {
  const base::Quat turned = mechanism.model.bodies()[s.body].pose.orientation * s.pose_B.orientation;
  const Vec3d across = transposedTimes(turned.matrix(), Vec3d{0, 1, 0});
  for (int a = 0; a < 3; ++a) {
    const bool fits =
        !s.mesh && (s.shape.shape == SurfaceShape::box || (s.shape.shape == SurfaceShape::cylinder && a == 2));
    if (fits && std::fabs(across[a]) > 1 - 1e-9) return a;
  }
  scene.fail("body", s.body - mechanism.ofVehicle.bodies, "shape",
             "is no box with faces across the plane of fluid.dimensions = 2, nor a cylinder along y; use these, or "
             "dimensions = 3");
}

} // namespace

std::vector<Vec3d> shapeMarkers(const coupling::BodyShape& shape, double spacing, double depth, int flat) {
  std::vector<Vec3d> markers;
  for (const Vec3d& p : pointsOf(shape, spacing, flat)) {
    const double d = distanceFrom(shape, p);
    if (d < 0 && d > -depth) markers.push_back(p);
  }
  return markers;
}

std::vector<coupling::BodyInFluid> bodiesInFluid(const scene::Scene& scene, const coupling::MechanismSetup& mechanism,
                                                 const fluid::FluidModel& model) {
  const double dx = model.spacing, depth = std::ceil(model.kernel().support() / dx) * dx;
  const bool plane = model.dimensions == 2;
  const double face = plane ? dx : dx * dx; // area per marker [m2]; [m] in two dimensions
  const std::vector<multibody::Body>& bodies = mechanism.model.bodies();
  std::vector<coupling::BodyInFluid> all;
  for (std::size_t b = mechanism.ofVehicle.bodies; b < bodies.size(); ++b) {
    coupling::BodyInFluid in{b, {}, 0};
    std::vector<const coupling::BodyShape*> former;
    double shifting = 0, turning = 0;
    for (const coupling::BodyShape& s : mechanism.shapes) {
      if (s.body != b) continue;
      if (2 * coupling::halfThickness(s) < dx)
        scene.fail(
            "body", b - mechanism.ofVehicle.bodies, "shape",
            fmt::format("is {:.3g} m thick, less than fluid.spacing = {:g} m: no marker of the fluid lies within; "
                        "make it thicker, or the spacing smaller",
                        2 * coupling::halfThickness(s), dx));
      for (const Vec3d& p : shapeMarkers(s, dx, depth, plane ? axisAcross(scene, mechanism, s) : -1)) {
        const Vec3d p_B = s.pose_B.toWorld(p);
        const auto within = [&p_B](const coupling::BodyShape* o) {
          return distanceFrom(*o, o->pose_B.toBody(p_B)) < 0;
        };
        if (std::any_of(former.begin(), former.end(), within)) continue;
        in.markers.push_back(p_B);
        if (distanceFrom(s, p) > -dx) shifting += face, turning += face * norm2(p_B);
      }
      former.push_back(&s);
    }
    if (in.markers.empty()) continue;
    // Half a spacing of fluid in front of each outermost marker moves with the body; twice that as a bound.
    const double ghost = 2 * 0.5 * model.density * dx;
    const auto& I = bodies[b].inertia_B.m;
    if (!bodies[b].fixed)
      in.gain = std::max(ghost * shifting / bodies[b].mass, ghost * turning / std::min({I[0][0], I[1][1], I[2][2]}));
    all.push_back(std::move(in));
  }
  return all;
}

double distanceFromBodies(const coupling::MechanismSetup& mechanism, const Vec3d& p) {
  double least = base::kInfinity;
  for (const coupling::BodyShape& s : mechanism.shapes) {
    const base::Pose& body = mechanism.model.bodies()[s.body].pose;
    least = std::min(least, distanceFrom(s, s.pose_B.toBody(body.toBody(p))));
  }
  return least;
}

} // namespace grouser::setup
