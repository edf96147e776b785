// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/pin_reactions.hpp"

#include <cmath>
#include <cstddef>

namespace grouser::vehicle {
namespace {

using base::cross;
using base::dot;
using base::Vec3d;

/// Places of the pins of a track.
struct Pins {
  Vec3d axis;                ///< direction of all pins, to the left
  std::vector<Vec3d> centre; ///< [m]
  std::vector<Vec3d> along;  ///< direction of the chain
};

/// Direction `a` of a body that rotates with w, a time `ago` earlier; to second order.
Vec3d earlier(const Vec3d& a, const Vec3d& w, double ago) {
  const Vec3d turned = cross(w, a) * ago;
  return a - turned + cross(w, turned) * (0.5 * ago);
}

Vec3d unit(const Vec3d& a) { return a * (1 / base::norm(a)); }

/// Places a time `ago` before `state` [s].
Pins placePins(const Assembly& vehicle, const Track& track, const multibody::State& state, double ago) {
  const auto axisOf = [&](int shoe, const Vec3d& axis) {
    return earlier(base::rotate(state.pose[shoe].orientation, axis), state.twist[shoe].w, ago);
  };
  Pins pins;
  const std::size_t count = track.shoes.size();
  for (std::size_t i = 0; i < count; ++i) {
    const int behind = track.shoes[i], ahead = track.shoes[(i + 1) % count];
    const Vec3d x = axisOf(behind, {1, 0, 0});
    pins.axis += axisOf(behind, {0, 1, 0});
    pins.centre.push_back(state.pose[behind].position - ago * state.twist[behind].v +
                          0.5 * vehicle.spec.shoe.pitch * x);
    pins.along.push_back(unit(x + axisOf(ahead, {1, 0, 0})));
  }
  pins.axis = unit(pins.axis);
  return pins;
}

/// Sum of the squares of the moments about the pins, apart from pin damping [N2 m2]: zero for the directions along
/// which the solver's reactions act.
double momentsAboutPins(const Track& track, const multibody::State& state, const Pins& pins) {
  double sum = 0;
  for (const int joint : track.shoeJoints) {
    const multibody::JointReading& pin = state.joint[joint];
    const double moment = dot(pin.torque, pins.axis) + pin.axisForce; // the joint's axis points to the right
    sum += moment * moment;
  }
  return sum;
}

/// Subtracts the self-stress that leaves the least norm.
void share(const Pins& pins, double length, std::vector<PinReaction>& reactions) {
  const auto count = static_cast<double>(reactions.size());
  const double perLength2 = 1 / (length * length);
  Vec3d centre, moment;
  for (const Vec3d& p : pins.centre) centre += p * (1 / count);
  double force = 0, size = 0;
  std::vector<Vec3d> lever;
  for (std::size_t i = 0; i < reactions.size(); ++i) {
    lever.push_back(cross(centre - pins.centre[i], pins.axis));
    force -= dot(reactions[i].force, pins.axis) + dot(reactions[i].moment, lever[i]) * perLength2;
    size += 1 + base::norm2(lever[i]) * perLength2;
    moment -= reactions[i].moment * (1 / count);
  }
  force /= size;
  moment -= pins.axis * dot(moment, pins.axis);
  for (std::size_t i = 0; i < reactions.size(); ++i) {
    reactions[i].force += pins.axis * force;
    reactions[i].moment += moment + lever[i] * force;
  }
}

} // namespace

std::vector<PinReaction> pinReactions(const Assembly& vehicle, int track, const multibody::State& state, double step) {
  const Track& t = vehicle.tracks[static_cast<std::size_t>(track)];
  // Reactions act along the axes at the start of the step, except in the few steps that the solver linearises again at
  // their end. A large self-stress makes the difference visible.
  Pins pins = placePins(vehicle, t, state, step);
  if (Pins atEnd = placePins(vehicle, t, state, 0);
      momentsAboutPins(t, state, atEnd) < momentsAboutPins(t, state, pins))
    pins = std::move(atEnd);

  std::vector<PinReaction> reactions;
  for (const int joint : t.shoeJoints) {
    PinReaction& pin = reactions.emplace_back();
    pin.force = state.joint[joint].force, pin.moment = state.joint[joint].torque;
  }
  share(pins, vehicle.spec.shoe.padHalfWidth, reactions);
  for (std::size_t i = 0; i < reactions.size(); ++i) {
    reactions[i].tension = -dot(reactions[i].force, pins.along[i]);
    reactions[i].lateral = dot(reactions[i].force, pins.axis);
    reactions[i].bending = base::norm(cross(pins.axis, reactions[i].moment));
  }
  return reactions;
}

} // namespace grouser::vehicle
