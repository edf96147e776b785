// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/surface_motion.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grouser::setup {

using base::Vec3d;

namespace {

/// The angle of `turns` in [0, 2 pi): base::sin takes no angle without bound.
double angleOf(double turns) { return 2 * base::kPi * (turns - std::floor(turns)); }

} // namespace

SurfaceMotion::SurfaceMotion(const scene::SurfaceSection& s, const Vec3d& centre)
    : pivot_(s.pivot.value_or(centre)), arm_(centre - pivot_), velocity_(s.velocity.value_or(Vec3d{})),
      spin_(s.spin.value_or(Vec3d{})), amplitude_(s.amplitude.value_or(Vec3d{})), frequency_(s.frequency.value_or(0)),
      phase_(s.phase.value_or(0) / 360), start_(s.start.value_or(0)),
      until_(s.until.value_or(std::numeric_limits<double>::infinity())) {}

SurfaceMotion::State SurfaceMotion::at(double time) const {
  const bool moving = time >= start_ && time < until_;
  const double t = std::clamp(time, start_, until_) - start_;
  State s;
  s.centre = pivot_ + velocity_ * t;
  if (moving) s.velocity = velocity_, s.spin = spin_;
  if (norm2(amplitude_) > 0) {
    const double angle = angleOf(frequency_ * t + phase_), zero = angleOf(phase_);
    s.centre += amplitude_ * (base::sin(angle) - base::sin(zero));
    if (moving) s.velocity += amplitude_ * (2 * base::kPi * frequency_ * base::cos(angle));
  }
  if (const double rate = norm(spin_); rate > 0) {
    const double half = 0.5 * angleOf(rate * t / (2 * base::kPi));
    const Vec3d v = spin_ * (base::sin(half) / rate);
    s.turned = base::Quat{base::cos(half), v.x, v.y, v.z}.normalized();
  }
  const Vec3d arm = norm2(arm_) > 0 ? rotate(s.turned, arm_) : Vec3d{};
  s.centre += arm;
  s.velocity += cross(s.spin, arm);
  return s;
}

} // namespace grouser::setup
