// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/track_watch.hpp"

#include "vehicle/travel.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <vector>

namespace grouser::vehicle {

using base::Vec3d;

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Name of a body's part: "left shoe 12".
std::string nameOf(const Assembly& vehicle, int body) {
  for (const Part& part : vehicle.parts)
    if (part.body == body) return part.name;
  return vehicle.model.bodies()[at(body)].name;
}

std::string remedy(const Assembly& vehicle) {
  return fmt::format("tighten the track (idler.preload of the vehicle file, {:g} N), turn and drive more gently "
                     "(driver), or use a smaller time_step",
                     vehicle.spec.idler.preload);
}

/// True if a closed polygon encloses a point of the track plane.
bool runsAround(const std::vector<Vec3d>& corners, const Vec3d& point) {
  bool inside = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Vec3d &a = corners[i], &b = corners[j];
    if ((a.z > point.z) != (b.z > point.z) && point.x < a.x + (point.z - a.z) / (b.z - a.z) * (b.x - a.x))
      inside = !inside;
  }
  return inside;
}

} // namespace

SidewaysShoe maxLateralShift(const Assembly& vehicle, int track, const multibody::State& state) {
  const Track& t = vehicle.tracks[at(track)];
  const base::Pose pose_W = vehiclePose(vehicle, state);
  SidewaysShoe worst;
  for (std::size_t i = 0; i < t.shoes.size(); ++i) {
    const double shift = std::fabs(pose_W.toBody(state.pose[at(t.shoes[i])].position).y - t.y);
    if (!(shift <= worst.shift)) worst = {static_cast<int>(i), shift};
    if (std::isnan(worst.shift)) break;
  }
  return worst;
}

LiftedWheel maxLifted(const Assembly& vehicle, int track, const multibody::State& state) {
  const Track& t = vehicle.tracks[at(track)];
  const VehicleSpec& spec = vehicle.spec;
  const base::Pose pose_W = vehiclePose(vehicle, state);
  const double halfPitch = 0.5 * spec.shoe.pitch;
  std::vector<double> gap(t.wheels.size(), std::numeric_limits<double>::infinity());
  std::vector<Vec3d> axle_V;
  for (const int wheel : t.wheels) axle_V.push_back(pose_W.toBody(state.pose[at(wheel)].position));
  for (const int shoe : t.shoes) {
    const base::Pose& pose = state.pose[at(shoe)];
    const Vec3d rear = pose_W.toBody(pose.toWorld({-halfPitch, 0, spec.shoe.plateTop}));
    const Vec3d front = pose_W.toBody(pose.toWorld({halfPitch, 0, spec.shoe.plateTop}));
    for (std::size_t i = 0; i < t.wheels.size(); ++i) {
      const double s = (axle_V[i].x - rear.x) / (front.x - rear.x);
      // Consider the plates under the wheel, with a margin for gaps between neighbours where the track is folded.
      if (!(s >= -0.1 && s <= 1.1) || 0.5 * (rear.z + front.z) > axle_V[i].z) continue;
      gap[i] = std::min(gap[i], axle_V[i].z - spec.roadWheel.radius - (rear.z + s * (front.z - rear.z)));
    }
  }
  LiftedWheel worst;
  for (std::size_t i = 0; i < gap.size(); ++i)
    if (gap[i] > worst.gap) worst = {static_cast<int>(i), gap[i]};
  return worst;
}

UnguidedWheel unguidedWheel(const Assembly& vehicle, int track, const multibody::State& state, double lift) {
  const Track& t = vehicle.tracks[at(track)];
  const VehicleSpec& spec = vehicle.spec;
  // A shoe faces a wheel within this distance, with a margin for gaps between neighbours where the track is folded.
  const double facing = 0.6 * spec.shoe.pitch;
  const Vec3d up = base::rotate(vehiclePose(vehicle, state).orientation, {0, 0, 1});
  const auto seen = [&](int body, double radius, double side) { // by shoes facing up: 1, down: -1
    UnguidedWheel nearest{-1, std::numeric_limits<double>::infinity(), 0};
    for (const int shoe : t.shoes) {
      const Vec3d axle_S = state.pose[at(shoe)].toBody(state.pose[at(body)].position);
      const double gap = axle_S.z - spec.shoe.plateTop - radius;
      if (std::fabs(axle_S.x) > facing || axle_S.z < 0 || !(gap < nearest.gap)) continue;
      if (side * base::dot(up, base::rotate(state.pose[at(shoe)].orientation, {0, 0, 1})) <= 0) continue;
      nearest = {body, gap, std::fabs(axle_S.y)};
    }
    return nearest;
  };
  const auto off = [&](const UnguidedWheel& w) {
    return w.body >= 0 && w.gap > lift && w.beside > 0.5 * spec.shoe.hornHeight;
  };
  for (const int wheel : t.wheels)
    if (const UnguidedWheel w = seen(wheel, spec.roadWheel.radius, 1); off(w)) return w;
  for (const int roller : t.rollers)
    if (const UnguidedWheel w = seen(roller, spec.roller.radius, -1); off(w)) return w;
  return {};
}

int outsideLoop(const Assembly& vehicle, int track, const multibody::State& state) {
  const Track& t = vehicle.tracks[at(track)];
  const base::Pose pose_W = vehiclePose(vehicle, state);
  const Vec3d pin{0.5 * vehicle.spec.shoe.pitch, 0, 0};
  std::vector<Vec3d> pins_V;
  pins_V.reserve(t.shoes.size());
  for (const int shoe : t.shoes) pins_V.push_back(pose_W.toBody(state.pose[at(shoe)].toWorld(pin)));
  std::vector<int> within{t.sprocket, t.idler};
  within.insert(within.end(), t.wheels.begin(), t.wheels.end());
  within.insert(within.end(), t.rollers.begin(), t.rollers.end());
  for (const int body : within)
    if (!runsAround(pins_V, pose_W.toBody(state.pose[at(body)].position))) return body;
  return -1;
}

std::string thrownTrack(const Assembly& vehicle, int track, const multibody::State& state, double lift) {
  const Track& t = vehicle.tracks[at(track)];
  const char* side = sideName(t.side);
  const double horn = vehicle.spec.shoe.hornHeight;
  const SidewaysShoe s = maxLateralShift(vehicle, track, state);
  if (!(s.shift <= horn))
    return fmt::format("{} track thrown: {} is {:.0f} mm beside its wheels, more than a horn's height of {:.0f} mm; {}",
                       side, nameOf(vehicle, t.shoes[at(s.shoe)]), 1e3 * s.shift, 1e3 * horn, remedy(vehicle));
  // Check the wheels only if a shoe is beside its wheels, which is rare.
  const UnguidedWheel w = s.shift > 0.5 * horn ? unguidedWheel(vehicle, track, state, lift) : UnguidedWheel{};
  if (w.body >= 0)
    return fmt::format("{} track thrown: {} is {:.0f} mm off its plates, more than {:.0f} mm, and {:.0f} mm beside "
                       "their horns, more than half of their height of {:.0f} mm; {}",
                       side, nameOf(vehicle, w.body), 1e3 * w.gap, 1e3 * lift, 1e3 * w.beside, 1e3 * horn,
                       remedy(vehicle));
  if (const int body = outsideLoop(vehicle, track, state); body >= 0)
    return fmt::format("{} track thrown: it no longer runs around {}; {}", side, nameOf(vehicle, body),
                       remedy(vehicle));
  return {};
}

} // namespace grouser::vehicle
