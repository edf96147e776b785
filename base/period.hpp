// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/position.hpp"

namespace grouser::base {

/// Periodic boundaries of a scene. Lengths are integers in units of position, so that the periodic images of a point
/// differ by exactly one period, on every device and rank.
struct Period {
  Vec3l low{};    ///< the lower boundaries
  Vec3l length{}; ///< period length along each axis; 0 if the axis is not periodic

  GROUSER_HD bool along(int axis) const { return length[axis] != 0; }
  GROUSER_HD bool any() const { return along(0) || along(1) || along(2); }

  /// Number of periods that maps coordinate `u`, at most one period outside, into the domain when added to it.
  GROUSER_HD int periodsBack(int axis, std::int64_t u) const {
    return !along(axis) ? 0 : u < low[axis] ? 1 : u >= low[axis] + length[axis] ? -1 : 0;
  }
  /// Maps a point at most one period outside into the domain.
  GROUSER_HD Vec3l wrapped(Vec3l u) const {
    for (int a = 0; a < 3; ++a) u[a] += periodsBack(a, u[a]) * length[a];
    return u;
  }
  /// Vector from `a` to the nearest image of `b` (minimum image); both points at most a quarter of a period outside.
  GROUSER_HD Vec3l apart(const Position& a, const Position& b) const {
    Vec3l d = toUnits(b) - toUnits(a);
    for (int k = 0; k < 3; ++k) {
      if (!along(k)) continue;
      if (2 * d[k] >= length[k])
        d[k] -= length[k];
      else if (2 * d[k] < -length[k])
        d[k] += length[k];
    }
    return d;
  }
};

} // namespace grouser::base
