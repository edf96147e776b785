// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

namespace grouser::multibody {

/// Velocity of a rigid body, world components.
struct Twist {
  base::Vec3d v; ///< velocity of the centre of mass [m/s]
  base::Vec3d w; ///< angular velocity [rad/s]
};

/// Force and torque about the centre of mass, world components.
struct Wrench {
  base::Vec3d force;  ///< [N]
  base::Vec3d torque; ///< [N m]
};

/// R I R^T: an inertia about the centre of mass, or its inverse, in world axes.
inline base::Mat3d rotatedInertia(const base::Mat3d& R, const base::Mat3d& I) {
  const base::Mat3d RI = R * I;
  base::Mat3d W;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) {
      W.m[i][j] = RI.m[i][0] * R.m[j][0] + RI.m[i][1] * R.m[j][1] + RI.m[i][2] * R.m[j][2];
      W.m[j][i] = W.m[i][j];
    }
  return W;
}

} // namespace grouser::multibody
