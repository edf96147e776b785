// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/vehicle_shape.hpp"

#include "vehicle/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace grouser::events {

namespace {

/// Corners of the pads of all shoes of a loop, with grousers, relative to level ground.
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

} // namespace

VehicleShape shapeOf(const vehicle::VehicleSpec& spec, double gravity) {
  const vehicle::Assembly drawn = vehicle::assemble(spec);
  VehicleShape s;
  s.gravity = gravity;
  s.controlled = {0.5 * (spec.roadWheel.firstX + spec.lastWheelX()), spec.roadWheel.z - spec.roadWheel.radius};
  s.rear = s.front = -1e300;
  const std::vector<SidePoint> corners = padCorners(spec, drawn.wrap);
  for (const SidePoint& p : corners) s.rear = std::max(s.rear, -p.x), s.front = std::max(s.front, p.x);
  for (const SidePoint& p : corners)
    for (const SidePoint& q : corners) s.diagonal = std::max(s.diagonal, std::hypot(q.x - p.x, q.z - p.z));
  s.halfWidth = spec.trackOffset + spec.shoe.padHalfWidth;
  s.firstWheel = spec.roadWheel.firstX;
  s.lastWheel = spec.lastWheelX();
  for (const multibody::Body& body : drawn.model.bodies()) {
    s.mass += body.mass;
    s.massCentre.x += body.mass * body.pose.position.x, s.massCentre.z += body.mass * body.pose.position.z;
  }
  s.massCentre.x /= s.mass, s.massCentre.z = s.massCentre.z / s.mass - spec.groundHeight();
  s.tread = 2 * spec.trackOffset, s.padWidth = 2 * spec.shoe.padHalfWidth;
  s.pitchRadius = spec.pitchRadius(), s.friction = spec.contact.frictionGround;
  s.highestStep = highestStep(spec, gravity);
  return s;
}

GapBounds gapBounds(const VehicleShape& shape) {
  const double x = shape.massCentre.x;
  return {std::min(x - shape.firstWheel, shape.lastWheel - x), std::min(x + shape.rear, shape.front - x),
          shape.diagonal};
}

double tippingSlope(const VehicleShape& shape) { return shape.halfWidth / shape.massCentre.z; }

double turningMoment(const VehicleShape& shape, double friction, double weight) {
  return friction * weight * shape.groundRun() / 4;
}

} // namespace grouser::events
