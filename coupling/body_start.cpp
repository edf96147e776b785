// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
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

/// Throws if points of `a` are too deep inside the surface measured by `overlap` [m]. `other`: name of that surface.
void checkDepth(const PlacedShape& a, const std::string& body, const std::string& other, double thickness,
                const std::function<double(const Vec3d&)>& overlap) {
  constexpr double kMax = 0.02; // [-] fraction of half the thickness
  double deepest = 0;
  Vec3d place;
  for (const contact::SurfaceSample& s : a.points) {
    const Vec3d p = a.pose.toWorld(s.centre.as<double>());
    if (const double depth = overlap(p); depth > deepest) deepest = depth, place = p;
  }
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
      checkDepth(a, nameOf(a), "the ground", thickness,
                 [&](const Vec3d& p) { return terrain->height(p.x, p.y) - p.z; });
    for (const Obstacle& o : obstacles)
      if (overlapAt(o.surface, o.surface.start, a.pose.position, reach) > 0)
        checkDepth(a, nameOf(a), o.surface.name, thickness,
                   [&](const Vec3d& p) { return overlapAt(o.surface, o.surface.start, p, 0); });
  }
  ContactParts parts;
  addBodyParts(parts, setup, model);
  for (const ContactParts::Pair& pair : parts.pairs) {
    const PlacedShape &a = placed[static_cast<std::size_t>(pair.part)],
                      &b = placed[static_cast<std::size_t>(pair.other)];
    const auto overlap = [&b](const Vec3d& p) { return -distanceFrom(b.shape, b.pose.toBody(p)); };
    if (overlap(a.pose.position) + norm(halfExtent(a.shape.shape)) > 0)
      checkDepth(a, nameOf(a), fmt::format("body \"{}\"", nameOf(b)),
                 std::min(halfThickness(a.shape), halfThickness(b.shape)), overlap);
  }
}

} // namespace grouser::coupling
