// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstdint>

namespace grouser::contact {

/// Pose and motion of a rigid part, in world components. `origin` and `rotation` define the frame of its sphere set;
/// loads act about its body's centre of mass `centre`.
struct PartMotion {
  base::Vec3d origin;   ///< [m]
  base::Mat3d rotation; ///< part frame to world
  base::Vec3d centre;   ///< [m]
  base::Vec3d velocity; ///< velocity of `centre` [m/s]
  base::Vec3d spin;     ///< [rad/s]

  GROUSER_HD base::Vec3d toPart(const base::Vec3d& p_W) const { return transposedTimes(rotation, p_W - origin); }
  GROUSER_HD base::Vec3d toWorld(const base::Vec3d& p_P) const { return origin + rotation * p_P; }
  GROUSER_HD base::Vec3d velocityAt(const base::Vec3d& p_W) const { return velocity + cross(spin, p_W - centre); }
};

/// Sum of contact loads on one part about its centre of mass, in quanta of force and torque: exact and
/// order-independent.
struct PartLoad {
  base::Vec3l force, torque;
};

} // namespace grouser::contact
