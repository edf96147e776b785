// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "multibody/state.hpp"
#include "vehicle/assembly.hpp"
#include "vehicle/observers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace grouser::test {

/// Analytic contact in the planes of the tracks: wheels are circles, shoes are plate segments with a boss on each pin
/// and four points on level ground, sprocket gaps are arcs. Drives the vehicle without meshes or sphere sets, and
/// is the reference for them. Spring and dashpot in parallel, friction regularised below `creep`.
struct PlaneContactOptions {
  double stiffness = 1e7;    ///< both planes together [N/m]
  double dampingRatio = 0.2; ///< for a shoe on this spring [-]
  double frictionInside = 0.35, frictionGround = 0.8;
  double creep = 0.01;          ///< sliding speed of full friction inside [m/s]
  double tangentialRatio = 0.8; ///< on the ground [-]
  double groundHeight = -std::numeric_limits<double>::infinity();
};

class PlaneContact {
public:
  PlaneContact(const vehicle::Assembly& vehicle, const PlaneContactOptions& options);

  /// Computes the wrenches in `loads` from the state.
  void apply(const multibody::State& state, multibody::Loads& loads);
  const vehicle::GroundLoads& ground() const { return ground_; }

private:
  /// Contact on body `shoe` at p_W with unit normal towards the shoe.
  void touch(int shoe, int other, const base::Vec3d& p_W, const base::Vec3d& normal, double overlap, double friction);
  void push(int body, const base::Vec3d& p_W, const base::Vec3d& force);
  void circleOnPlate(int shoe, int wheel, double radius);
  void bossInGap(int shoe, int sprocket);
  void pointsOnGround(int shoe);

  /// Tangential spring of one grouser tip.
  struct Grip {
    bool holds = false;
    base::Vec3d anchor;
  };

  const vehicle::Assembly& vehicle_;
  PlaneContactOptions options_;
  double damping_;
  double size_; ///< size of shoes and teeth relative to the default vehicle [-]
  const multibody::State* state_ = nullptr;
  multibody::Loads* loads_ = nullptr;
  vehicle::GroundLoads ground_;
  std::vector<std::array<Grip, 4>> grips_; ///< one entry per body
};

inline PlaneContact::PlaneContact(const vehicle::Assembly& vehicle, const PlaneContactOptions& options)
    : vehicle_(vehicle), options_(options),
      damping_(2 * options.dampingRatio * std::sqrt(options.stiffness * vehicle.spec.shoe.mass)),
      size_(vehicle.spec.shoe.pitch / 0.154), grips_(vehicle.model.bodies().size()) {}

inline void PlaneContact::touch(int shoe, int other, const base::Vec3d& p_W, const base::Vec3d& normal, double overlap,
                                double friction) {
  const auto velocity = [&](int body) {
    const multibody::Twist& t = state_->twist[body];
    return t.v + base::cross(t.w, p_W - state_->pose[body].position);
  };
  const base::Vec3d v = velocity(shoe) - velocity(other);
  const double normalSpeed = base::dot(v, normal);
  const double force = 0.5 * (options_.stiffness * overlap - damping_ * normalSpeed);
  if (force <= 0) return;
  const base::Vec3d sliding = v - normal * normalSpeed;
  const base::Vec3d total =
      normal * force - sliding * (friction * force / std::max(base::norm(sliding), options_.creep));
  push(shoe, p_W, total);
  push(other, p_W, -total);
}

inline void PlaneContact::push(int body, const base::Vec3d& p_W, const base::Vec3d& force) {
  loads_->external[body].force += force;
  loads_->external[body].torque += base::cross(p_W - state_->pose[body].position, force);
}

inline void PlaneContact::circleOnPlate(int shoe, int wheel, double radius) {
  constexpr double kHornStiffness = 1e6;
  const double plateY = 0.07 * size_, play = 0.012 * size_;
  const vehicle::ShoeSpec& s = vehicle_.spec.shoe;
  const base::Pose& pose = state_->pose[shoe];
  const double reach = radius + s.pitch;
  if (base::norm2(state_->pose[wheel].position - pose.position) > reach * reach) return;
  for (const double y : {-plateY, plateY}) {
    const base::Vec3d c = pose.toBody(state_->pose[wheel].toWorld({0, y, 0}));
    const base::Vec3d nearest{std::clamp(c.x, -s.halfLength, s.halfLength), c.y, s.plateTop};
    const base::Vec3d gap{c.x - nearest.x, 0, c.z - nearest.z};
    const double distance = base::norm(gap);
    if (distance >= radius || distance == 0) continue;
    const base::Vec3d normal = base::rotate(pose.orientation, gap * (-1 / distance));
    touch(shoe, wheel, pose.toWorld(nearest), normal, radius - distance, options_.frictionInside);
    // The horn between the two discs of the wheel.
    const double shift = c.y - y, beyond = std::fabs(shift) - play;
    if (beyond <= 0) continue;
    const base::Vec3d side = base::rotate(pose.orientation, {0, (shift > 0 ? 0.5 : -0.5) * kHornStiffness * beyond, 0});
    push(shoe, pose.toWorld(nearest), side);
    push(wheel, pose.toWorld(nearest), -side);
  }
}

inline void PlaneContact::bossInGap(int shoe, int sprocket) {
  // Gap of the default sprocket, from the pin: a seat arc over +-60 degrees, then a convex flank on either side.
  const double boss = 0.018 * size_, seat = 0.0185 * size_, flank = 0.06 * size_, flankX = 0.0680 * size_,
               flankY = -0.0393 * size_, tipY = 0.0162 * size_, ringY = 0.16 * size_;
  const vehicle::VehicleSpec& spec = vehicle_.spec;
  const base::Pose& wheel = state_->pose[sprocket];
  const double reach = spec.sprocketPinRadius() + spec.shoe.pitch;
  if (base::norm2(state_->pose[shoe].position - wheel.position) > reach * reach) return;
  for (const double ring : {-ringY, ringY}) {
    const base::Vec3d boss_W = state_->pose[shoe].toWorld({0.5 * spec.shoe.pitch, ring, 0});
    const base::Vec3d p = wheel.toBody(boss_W);
    const double r = std::sqrt(p.x * p.x + p.z * p.z);
    if (r > spec.sprocketPinRadius() + 0.05 * size_) continue;
    const double gap = 2 * base::kPi / spec.sprocket.teeth;
    const double k = gap * std::floor(base::atan2(p.z, p.x) / gap + 0.5);
    const base::Vec3d outward{base::cos(k), 0, base::sin(k)}, along{-base::sin(k), 0, base::cos(k)};
    const double x = base::dot(p, along), y = base::dot(p, outward) - spec.sprocketPinRadius();
    const double d = std::sqrt(x * x + y * y);

    const auto seatOrFlank = [&](double nx, double ny, double overlap) {
      if (overlap <= 0) return;
      const base::Vec3d normal = base::rotate(wheel.orientation, along * nx + outward * ny);
      touch(shoe, sprocket, boss_W - normal * boss, normal, overlap, options_.frictionInside);
    };
    if (d > 0 && -y >= 0.5 * d) {
      seatOrFlank(-x / d, -y / d, d + boss - seat);
      continue;
    }
    for (const double side : {-1.0, 1.0}) {
      const double fx = x - side * flankX, fy = y - flankY, distance = std::sqrt(fx * fx + fy * fy);
      if (flankY + fy * flank / distance < tipY) seatOrFlank(fx / distance, fy / distance, flank + boss - distance);
    }
  }
}

inline void PlaneContact::pointsOnGround(int shoe) {
  const vehicle::ShoeSpec& s = vehicle_.spec.shoe;
  const base::Pose& pose = state_->pose[shoe];
  const multibody::Twist& twist = state_->twist[shoe];
  if (pose.position.z - s.pitch > options_.groundHeight) return;
  int corner = 0;
  for (const double x : {-0.045 * size_, 0.045 * size_})
    for (const double y : {-0.1 * size_, 0.1 * size_}) {
      Grip& grip = grips_[shoe][corner++];
      const base::Vec3d tip = pose.toWorld({x, y, s.padBottom - s.grouserHeight});
      const base::Vec3d v = twist.v + base::cross(twist.w, tip - pose.position);
      const double normal = 0.25 * (options_.stiffness * (options_.groundHeight - tip.z) - damping_ * v.z);
      if (tip.z >= options_.groundHeight || normal <= 0) {
        grip.holds = false;
        continue;
      }
      // Cundall-Strack: a spring ties the tip to its last sticking point, which follows the tip during sliding.
      const double stiffness = 0.25 * options_.tangentialRatio * options_.stiffness;
      if (!grip.holds) grip = {true, tip};
      base::Vec3d stretch{grip.anchor.x - tip.x, grip.anchor.y - tip.y, 0};
      const double limit = options_.frictionGround * normal / stiffness, length = base::norm(stretch);
      const bool slides = length > limit;
      if (slides) {
        stretch = stretch * (limit / length);
        grip.anchor = tip + stretch;
      }
      const double drag = slides ? 0 : 0.25 * damping_;
      const base::Vec3d force = stretch * stiffness - base::Vec3d{v.x, v.y, 0} * drag + base::Vec3d{0, 0, normal};
      push(shoe, tip, force);
      ground_.force[shoe] += force;
    }
}

inline void PlaneContact::apply(const multibody::State& state, multibody::Loads& loads) {
  state_ = &state, loads_ = &loads;
  for (multibody::Wrench& wrench : loads.external) wrench = {};
  ground_.force.assign(loads.external.size(), {});
  for (const vehicle::Track& track : vehicle_.tracks)
    for (const int shoe : track.shoes) {
      for (const int wheel : track.wheels) circleOnPlate(shoe, wheel, vehicle_.spec.roadWheel.radius);
      for (const int roller : track.rollers) circleOnPlate(shoe, roller, vehicle_.spec.roller.radius);
      circleOnPlate(shoe, track.idler, vehicle_.spec.idler.radius);
      bossInGap(shoe, track.sprocket);
      pointsOnGround(shoe);
    }
}

} // namespace grouser::test
