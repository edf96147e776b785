// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/orientation.hpp"

#include "base/math.hpp"
#include "runs/support/section_fault.hpp"

#include <cmath>
#include <fmt/format.h>

namespace grouser::support {

using base::Quat;
using base::Vec3d;

namespace {
/// Tolerance of the length of quaternions, which are typed with a few digits.
constexpr double kQuaternionLength = 1e-3;
} // namespace

Quat orientationOf(const std::optional<Vec3d>& axis, const std::optional<double>& angle,
                   const std::vector<double>& orientation) {
  if (!orientation.empty()) {
    if (axis || angle)
      throw SectionFault("orientation", "is mutually exclusive with axis and angle; remove one of the two");
    if (orientation.size() != 4)
      throw SectionFault("orientation", "must have four entries w, x, y, z; correct the list");
    const Quat q{orientation[0], orientation[1], orientation[2], orientation[3]};
    const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (!(std::fabs(length - 1) <= kQuaternionLength))
      throw SectionFault("orientation", fmt::format("[-] has length {:.6g}; set a unit quaternion w, x, y, z", length));
    return q.normalized();
  }
  if (!angle) {
    if (axis) throw SectionFault("axis", "[-] requires angle; set both or neither");
    return {};
  }
  if (!axis) throw SectionFault("angle", "[deg] requires axis; set the rotation axis, e.g. [0, 1, 0]");
  if (norm2(*axis) == 0) throw SectionFault("axis", "[-] has zero length; set the rotation axis, e.g. [0, 1, 0]");
  const double half = *angle * (base::kPi / 360);
  const Vec3d v = base::sin(half) * normalized(*axis);
  return Quat{base::cos(half), v.x, v.y, v.z}.normalized();
}

Quat turnFromZ(const Vec3d& direction) {
  const Vec3d d = base::normalized(direction);
  if (d.z < -0.999999) return Quat{0, 1, 0, 0};
  return Quat{1 + d.z, -d.y, d.x, 0}.normalized();
}

} // namespace grouser::support
