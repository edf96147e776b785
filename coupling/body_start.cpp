// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "contact/shape_points.hpp"
#include "coupling/mechanism_setup.hpp"
#include "coupling/obstacles.hpp"
#include "terrain/height_field.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <functional>

namespace grouser::coupling {

using base::Vec3d;

namespace {

/// Shape in the world at the start of the mechanism.
struct PlacedShape {
  const BodyShape& shape;
  base::Pose pose;
  std::vector<contact::SurfaceSample> points;
};

/// Points of a shape in the world.
std::vector<Vec3d> pointsOf(const PlacedShape& a) {
  std::vector<Vec3d> points;
  for (const contact::SurfaceSample& s : a.points) points.push_back(a.pose.toWorld(s.centre.as<double>()));
  return points;
}

/// Surface points of an obstacle in the world; empty for planes, which are within no body, and hollow cylinders.
std::vector<Vec3d> pointsOf(const Obstacle& o) {
  const SurfaceSetup& s = o.surface;
  std::vector<Vec3d> points;
  if (s.mesh) {
    for (const Vec3d& v : s.mesh->mesh().vertices) points.push_back(s.start.toWorld(v));
  } else if (s.geometry.shape == contact::SurfaceShape::box || s.geometry.shape == contact::SurfaceShape::cylinder) {
    for (const contact::SurfaceSample& p : contact::shapePoints(s.geometry))
      points.push_back(s.start.toWorld(p.centre.as<double>()));
  }
  return points;
}

double depthIn(const PlacedShape& a, const Vec3d& p) { return -distanceFrom(a.shape, a.pose.toBody(p)); }

/// Throws if `points` of `a` or of the other surface are too deep inside the surface measured by `overlap` [m].
/// `other`: name of the other surface.
void checkDepth(const PlacedShape& a, const std::string& body, const std::string& other, double thickness,
                const std::vector<Vec3d>& points, const std::function<double(const Vec3d&)>& overlap) {
  constexpr double kMax = 0.02; // [-] fraction of half the thickness
  double deepest = 0;
  Vec3d place;
  for (const Vec3d& p : points)
    if (const double depth = overlap(p); depth > deepest) deepest = depth, place = p;
  if (deepest <= kMax * thickness) return;
  throw base::InputError(fmt::format("{}: body \"{}\" overlaps {} by {:.3g} m at ({:.3g}, {:.3g}, {:.3g}) m at the "
                                     "start, more than {:.3g} m; move the body",
                                     a.shape.place, body, other, deepest, place.x, place.y, place.z, kMax * thickness));
}

} // namespace

void requireApart(const MechanismSetup& setup, const multibody::Model& model, const std::vector<Obstacle>& obstacles,
                  const terrain::HeightField* terrain) {
  if (setup.shapes.empty()) return;
  const std::vector<multibody::Body>& bodies = model.bodies();
  std::vector<PlacedShape> placed;
  for (const BodyShape& s : setup.shapes)
    placed.push_back({s, multibody::compose(bodies[s.body].pose, s.pose_B), surfacePoints(s)});
  const auto nameOf = [&](const PlacedShape& a) { return bodies[a.shape.body].name; };
  for (const PlacedShape& a : placed) {
    if (bodies[a.shape.body].fixed) continue;
    const double reach = norm(halfExtent(a.shape.shape)), thickness = halfThickness(a.shape);
    if (terrain && setup.foundations.ground >= 0)
      checkDepth(a, nameOf(a), "the ground", thickness, pointsOf(a),
                 [&](const Vec3d& p) { return terrain->height(p.x, p.y) - p.z; });
    for (const Obstacle& o : obstacles) {
      if (!(overlapAt(o.surface, o.surface.start, a.pose.position, reach) > 0)) continue;
      checkDepth(a, nameOf(a), o.surface.name, thickness, pointsOf(a),
                 [&](const Vec3d& p) { return overlapAt(o.surface, o.surface.start, p, 0); });
      // An obstacle wholly inside the body overlaps none of the body's points.
      checkDepth(a, nameOf(a), o.surface.name, thickness, pointsOf(o), [&](const Vec3d& p) { return depthIn(a, p); });
    }
  }
  ContactParts parts;
  addBodyParts(parts, setup, model);
  for (const ContactParts::Pair& pair : parts.pairs) {
    const PlacedShape &a = placed[static_cast<std::size_t>(pair.part)],
                      &b = placed[static_cast<std::size_t>(pair.other)];
    if (!(depthIn(b, a.pose.position) + norm(halfExtent(a.shape.shape)) > 0)) continue;
    const std::string other = fmt::format("body \"{}\"", nameOf(b));
    const double thickness = std::min(halfThickness(a.shape), halfThickness(b.shape));
    checkDepth(a, nameOf(a), other, thickness, pointsOf(a), [&b](const Vec3d& p) { return depthIn(b, p); });
    // A body of larger bounding box may still be wholly inside the other: both directions count.
    checkDepth(a, nameOf(a), other, thickness, pointsOf(b), [&a](const Vec3d& p) { return depthIn(a, p); });
  }
}

} // namespace grouser::coupling
