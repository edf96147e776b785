// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "fluid/fluid_model.hpp"

#include <string>
#include <vector>

namespace grouser::fluid {

/// Initial state of a particle.
struct FluidParticle {
  base::Vec3d position;  ///< [m]
  base::Vec3d velocity;  ///< [m/s]
  double compression{0}; ///< rho/rho0 - 1 [-]
};

/// A point of a wall, which counts as fluid at rest with it. Layers of them, as thick as the kernel's support, lie
/// behind each wall.
struct WallMarker {
  base::Vec3d position;   ///< [m]
  base::Vec3d velocity{}; ///< along the wall, whose place does not change [m/s]
};

/// Motion of a rigid body in the fluid; vectors in world components.
struct BodyMotion {
  base::Pose pose;                               ///< of the body's frame at the end of the step
  base::Vec3d velocity, spin;                    ///< over the step, of the frame's origin [m/s], [rad/s]
  base::Vec3d acceleration, angularAcceleration; ///< for the extrapolation of wall pressures [m/s2], [rad/s2]
};

/// A rigid body in the fluid: its markers move with it.
struct FluidBody {
  std::string name;                 ///< in messages
  std::vector<base::Vec3d> markers; ///< in the body's frame [m]
  BodyMotion start;
  /// Its surface touches others, like those of wheels and shoes. A particle between two surfaces in contact is half a
  /// spacing from the markers of both, and would be squeezed out at the speed of sound: markers do not repel it, their
  /// pressure ignores the body's acceleration, which impacts make noisy, and the compression of particles beside them
  /// is limited to kPinchedCompression.
  bool touches = false;
};

struct FluidSetup {
  FluidModel model;
  base::Vec3d periodLow{}, periodHigh{}; ///< periodic boundaries along x and y where high is above low [m]
  std::vector<FluidParticle> particles;
  std::vector<WallMarker> markers; ///< of fixed walls
  std::vector<FluidBody> bodies;
  /// No shifting where div r falls below this, as at free surfaces: in three dimensions 2.5 for 1.3 spacings. 0: fluid
  /// without free surfaces [-].
  double surfaceDivergence = 0;
};

} // namespace grouser::fluid
