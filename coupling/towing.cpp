// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/towing.hpp"

#include "base/error.hpp"

namespace grouser::coupling {

using base::Vec3d;

void Towing::pull(const vehicle::Assembly& vehicle, const multibody::State& state, const vehicle::Driver& driver,
                  double dt, const Vec3d& gravity, multibody::Loads& loads) {
  const auto hull = static_cast<std::size_t>(vehicle.chassis);
  const vehicle::HitchMotion motion = vehicle::hitchMotion(vehicle, state, hitch_.options().point);
  before_ = state.twist[hull];
  ahead_ = {motion.forwardX, motion.forwardY, 0};
  lever_ = motion.position - state.pose[hull].position;
  wrench_ = {};
  if (const std::optional<double> start = driver.driveStart())
    wrench_.force = hitch_.step(motion, state.time - *start, dt, gravity);
  wrench_.torque = cross(lever_, wrench_.force);
  loads.external[hull].force += wrench_.force, loads.external[hull].torque += wrench_.torque;
}

void Towing::accountWork(const vehicle::Assembly& vehicle, const multibody::State& state, double dt) {
  const multibody::Twist& now = state.twist[static_cast<std::size_t>(vehicle.chassis)];
  const Vec3d v = 0.5 * (before_.v + now.v), w = 0.5 * (before_.w + now.w);
  const double power = dot(wrench_.force, v) + dot(wrench_.torque, w);
  work_ += power * dt;
  const Vec3d left{-ahead_.y, ahead_.x, 0};
  for (Sums* sums : {&rows_, &watch_}) {
    sums->forces += Vec3d{dot(wrench_.force, ahead_), dot(wrench_.force, left), wrench_.force.z};
    sums->speeds += dot(v + cross(w, lever_), ahead_), sums->taken -= power, ++sums->steps;
  }
}

HitchObservation Towing::observe(Means of) const {
  const Sums& s = of == Means::rows ? rows_ : watch_;
  const double share = s.steps > 0 ? 1 / static_cast<double>(s.steps) : 0.0;
  HitchObservation o;
  o.force = s.forces * share, o.pull = 0.0 - o.force.x;
  o.speed = s.speeds * share, o.power = s.taken * share, o.work = work_;
  o.towedWay = hitch_.way(), o.towedSpeed = hitch_.towedSpeed();
  return o;
}

std::vector<double> Towing::saveSums() const {
  return {work_.sum,      work_.lost,   rows_.forces.x, rows_.forces.y,
          rows_.forces.z, rows_.speeds, rows_.taken,    static_cast<double>(rows_.steps)};
}

double Towing::workOf(const std::vector<double>& sums) { return multibody::CompensatedSum{sums[0], sums[1]}; }

void Towing::restore(const std::vector<double>& state, const std::vector<double>& sums) {
  hitch_.restore(state);
  if (sums.size() != saveSums().size())
    throw base::InputError("hitch: the checkpoint belongs to another hitch; resume with the scene that was run");
  work_.sum = sums[0], work_.lost = sums[1];
  rows_ = {{sums[2], sums[3], sums[4]}, sums[5], sums[6], static_cast<std::int64_t>(sums[7])};
}

} // namespace grouser::coupling
