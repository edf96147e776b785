// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/surface_motion.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::coupling {

using base::Vec3d;

namespace {

/// Angle of `turns` in [0, 2 pi): base::sin requires a bounded argument.
double angleOf(double turns) { return 2 * base::kPi * (turns - std::floor(turns)); }

} // namespace

SurfaceMotion::State SurfaceMotion::at(double time) const {
  const bool moving = time >= law_.start && time < law_.until;
  const double t = std::clamp(time, law_.start, law_.until) - law_.start;
  State s;
  s.centre = law_.pivot + law_.velocity * t;
  if (moving) s.velocity = law_.velocity, s.spin = law_.spin;
  if (norm2(law_.amplitude) > 0) {
    const double angle = angleOf(law_.frequency * t + law_.phase), zero = angleOf(law_.phase);
    s.centre += law_.amplitude * (base::sin(angle) - base::sin(zero));
    if (moving) s.velocity += law_.amplitude * (2 * base::kPi * law_.frequency * base::cos(angle));
  }
  if (const double rate = norm(law_.spin); rate > 0) {
    const double half = 0.5 * angleOf(rate * t / (2 * base::kPi));
    const Vec3d v = law_.spin * (base::sin(half) / rate);
    s.turned = base::Quat{base::cos(half), v.x, v.y, v.z}.normalized();
  }
  s.pivot = s.centre;
  const Vec3d arm = norm2(arm_) > 0 ? rotate(s.turned, arm_) : Vec3d{};
  s.centre += arm;
  s.velocity += cross(s.spin, arm);
  return s;
}

} // namespace grouser::coupling
