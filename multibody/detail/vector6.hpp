// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "multibody/detail/block.hpp"

namespace grouser::multibody::detail {

inline constexpr Vector6 kStill{}; ///< zero motion

/// Converts a node's six numbers to (linear, angular) and back.
inline base::Vec3d linear(const Vector6& x) { return {x[0], x[1], x[2]}; }
inline base::Vec3d angular(const Vector6& x) { return {x[3], x[4], x[5]}; }
inline void set(Vector6& x, const base::Vec3d& v, const base::Vec3d& w) {
  x[0] = v.x, x[1] = v.y, x[2] = v.z, x[3] = w.x, x[4] = w.y, x[5] = w.z;
}
inline void add(Vector6& x, const base::Vec3d& v, const base::Vec3d& w) {
  x[0] += v.x, x[1] += v.y, x[2] += v.z, x[3] += w.x, x[4] += w.y, x[5] += w.z;
}

} // namespace grouser::multibody::detail
