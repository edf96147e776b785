// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

namespace grouser::multibody {

/// Velocity of a rigid body, world components.
struct Twist {
  base::Vec3d v; ///< of the centre of mass [m/s]
  base::Vec3d w; ///< angular velocity [rad/s]
};

/// Force and torque about the centre of mass, world components.
struct Wrench {
  base::Vec3d force;  ///< [N]
  base::Vec3d torque; ///< [N m]
};

} // namespace grouser::multibody
