// SPDX-License-Identifier: BSD-3-Clause
#include "runs/events/vehicle_shape.hpp"

#include "base/math.hpp"
#include "vehicle/assembly.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::events {

namespace {

/// Corners of the pads of all shoes of a loop, grousers included, over level ground.
std::vector<SidePoint> padCorners(const vehicle::VehicleSpec& spec, const vehicle::Wrap& wrap) {
  std::vector<SidePoint> corners;
  for (int i = 0; i < spec.shoe.count; ++i) {
    const vehicle::PlanePoint middle = wrap.shoeCentre(i);
    const double c = std::cos(wrap.shoeAngle(i)), s = std::sin(wrap.shoeAngle(i));
    const double below = spec.shoe.padBottom - spec.shoe.grouserHeight;
    for (const double along : {-spec.shoe.halfLength, spec.shoe.halfLength})
      corners.push_back({middle.x + c * along - s * below, middle.z + s * along + c * below - spec.groundHeight()});
  }
  return corners;
}

/// Height of the underside of a convex outline at `x`, of points in any order: of the lines between two points on
/// either side the lowest.
double undersideAt(const std::vector<SidePoint>& points, double x) {
  double lowest = 1e300;
  for (const SidePoint& a : points)
    for (const SidePoint& b : points)
      if (a.x <= x && x <= b.x && b.x - a.x > 1e-9)
        lowest = std::min(lowest, a.z + (b.z - a.z) * (x - a.x) / (b.x - a.x));
  return lowest;
}

} // namespace

VehicleShape shapeOf(const vehicle::VehicleSpec& spec) {
  const vehicle::Assembly drawn = vehicle::assemble(spec);
  VehicleShape s;
  s.outline = padCorners(spec, drawn.wrap);
  s.rear = s.front = -1e300;
  for (const SidePoint& p : s.outline) s.rear = std::max(s.rear, -p.x), s.front = std::max(s.front, p.x);
  s.halfWidth = spec.trackOffset + spec.shoe.padHalfWidth;
  s.firstWheel = spec.roadWheel.firstX;
  s.lastWheel = spec.roadWheel.firstX + (spec.roadWheel.count - 1) * spec.roadWheel.spacing;
  for (const multibody::Body& body : drawn.model.bodies()) {
    s.mass += body.mass;
    s.massCentre.x += body.mass * body.pose.position.x, s.massCentre.z += body.mass * body.pose.position.z;
  }
  s.massCentre.x /= s.mass, s.massCentre.z = s.massCentre.z / s.mass - spec.groundHeight();
  s.tread = 2 * spec.trackOffset, s.padWidth = 2 * spec.shoe.padHalfWidth;
  s.pitchRadius = spec.pitchRadius(), s.friction = spec.contact.frictionGround;
  return s;
}

double highestStep(const VehicleShape& shape) {
  constexpr int kMostPitch = 60; // degrees
  double highest = 0;
  for (int degrees = 1; degrees <= kMostPitch; ++degrees) {
    const double angle = degrees * base::kPi / 180, c = std::cos(angle), s = std::sin(angle);
    const auto turned = [c, s](const SidePoint& p) { return SidePoint{c * p.x - s * p.z, s * p.x + c * p.z}; };
    std::vector<SidePoint> points;
    double ground = 1e300;
    for (const SidePoint& p : shape.outline) points.push_back(turned(p)), ground = std::min(ground, points.back().z);
    highest = std::max(highest, undersideAt(points, turned(shape.massCentre).x) - ground);
  }
  return highest;
}

GapBounds gapBounds(const VehicleShape& shape) {
  const double x = shape.massCentre.x;
  return {std::min(x - shape.firstWheel, shape.lastWheel - x), std::min(x + shape.rear, shape.front - x)};
}

double tippingSlope(const VehicleShape& shape) { return shape.halfWidth / shape.massCentre.z; }

double turningMoment(const VehicleShape& shape, double friction, double weight) {
  return friction * weight * shape.groundRun() / 4;
}

} // namespace grouser::events
