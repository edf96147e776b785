// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/hitch.hpp"

#include "base/error.hpp"
#include "vehicle/driver.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::vehicle {

using base::Vec3d;

namespace {
Vec3d levelled(const Vec3d& v) { return {v.x, v.y, 0}; }
} // namespace

Hitch::Hitch(const HitchOptions& options) : options_(options) {
  const HitchOptions& o = options_;
  if (!(o.start >= 0) || !(o.ramp >= 0)) throw base::InputError("hitch: start and ramp must be >= 0");
  const bool sled = o.kind == HitchKind::sled;
  if (sled && (!(o.mass > 0) || !(o.friction >= 0) || !(o.length > 0)))
    throw base::InputError("hitch: a sled requires mass > 0, length > 0 and friction >= 0");
  if ((sled || o.kind == HitchKind::speed) && (!(o.stiffness > 0) || !(o.damping >= 0)))
    throw base::InputError("hitch: stiffness must be > 0 and damping >= 0");
}

double Hitch::towedSpeed() const {
  switch (options_.kind) {
  case HitchKind::sled:
    return norm(motion_);
  case HitchKind::speed:
    return speed_;
  default:
    return 0;
  }
}

void Hitch::takeHold(const HitchMotion& m) {
  holds_ = true;
  origin_ = levelled(m.position), line_ = {m.forwardX, m.forwardY, 0};
  begun_ = speed_ = dot(m.velocity, line_);
  place_ = origin_ - line_ * options_.length, motion_ = line_ * begun_;
}

void Hitch::command(std::optional<double> value) {
  if (value && options_.kind != HitchKind::force && options_.kind != HitchKind::speed)
    throw base::InputError("hitch: force and speed of a ramp or sled cannot be set; use kind force or speed");
  command_ = value;
}

Vec3d Hitch::step(const HitchMotion& m, double sinceDrive, double dt, const Vec3d& gravity) {
  const HitchOptions& o = options_;
  const double since = sinceDrive - o.start - late_;
  if (!(since >= 0)) return {};
  if (!holds_) takeHold(m);
  const Vec3d ahead{m.forwardX, m.forwardY, 0};
  switch (o.kind) {
  case HitchKind::force:
    return ahead * (-smoothRamp(since, 0, o.ramp) * command_.value_or(o.force));
  case HitchKind::ramp:
    return ahead * -(o.force + o.rate * since);
  case HitchKind::sled:
    return pullSled(m, dt, gravity);
  case HitchKind::speed:
    return pullCarriage(m, since, dt);
  }
  return {};
}

Vec3d Hitch::pullSled(const HitchMotion& m, double dt, const Vec3d& gravity) {
  const HitchOptions& o = options_;
  const Vec3d rope = levelled(m.position) - place_;
  const double length = norm(rope);
  const Vec3d along = length > 0 ? rope * (1 / length) : line_;
  const double stretch = length - o.length;
  const double rate = dot(levelled(m.velocity) - motion_, along);
  const double tension = stretch > 0 ? std::max(0.0, o.stiffness * stretch + o.damping * rate) : 0.0;

  // Apply the forces first, then friction against the resulting velocity.
  Vec3d velocity = motion_ + (along * (tension / o.mass) + levelled(gravity)) * dt;
  const double speed = norm(velocity), braked = o.friction * std::fabs(gravity.z) * dt;
  velocity = speed > braked ? velocity * (1 - braked / speed) : Vec3d{};
  motion_ = velocity, place_ += velocity * dt, way_ += norm(velocity) * dt;
  return along * -tension;
}

Vec3d Hitch::pullCarriage(const HitchMotion& m, double since, double dt) {
  const HitchOptions& o = options_;
  const double share = smoothRamp(since, 0, o.ramp);
  const double ahead = dot(levelled(m.position) - origin_, line_) - way_;
  speed_ = (1 - share) * begun_ + share * command_.value_or((1 - o.slip) * m.trackSpeed);
  const double force = o.stiffness * ahead + o.damping * (dot(m.velocity, line_) - speed_);
  way_ += speed_ * dt;
  return line_ * -force;
}

std::vector<double> Hitch::save() const {
  std::vector<double> saved{holds_ ? 1.0 : 0.0, origin_.x, origin_.y, line_.x,   line_.y, begun_,
                            place_.x,           place_.y,  motion_.x, motion_.y, way_,    speed_};
  if (late_ > 0) saved.push_back(late_);
  return saved;
}

void Hitch::restore(const std::vector<double>& s) {
  constexpr std::size_t kAlways = 12;
  if (s.size() != kAlways && s.size() != kAlways + 1)
    throw base::InputError("hitch: the checkpoint belongs to another hitch; resume with the scene that wrote it");
  holds_ = s[0] != 0;
  origin_ = {s[1], s[2], 0}, line_ = {s[3], s[4], 0}, begun_ = s[5];
  place_ = {s[6], s[7], 0}, motion_ = {s[8], s[9], 0}, way_ = s[10], speed_ = s[11];
  late_ = s.size() > kAlways ? s[kAlways] : 0;
}

} // namespace grouser::vehicle
