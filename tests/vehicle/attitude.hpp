// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "base/vec.hpp"

namespace grouser::vehicle::testing {

inline constexpr double kDegree = base::kPi / 180; // [rad]

/// Rotation by `angle` [rad] about x, y or z: axis 0, 1 or 2.
inline base::Quat about(int axis, double angle) {
  base::Quat q{base::cos(angle / 2), 0, 0, 0};
  (axis == 0 ? q.x : axis == 1 ? q.y : q.z) = base::sin(angle / 2);
  return q;
}

} // namespace grouser::vehicle::testing
