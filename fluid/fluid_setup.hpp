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

/// Wall point, which acts like fluid at rest with the wall. Behind each wall surface are layers of markers as thick as
/// the kernel support.
struct WallMarker {
  base::Vec3d position;   ///< [m]
  base::Vec3d velocity{}; ///< tangential velocity of the wall [m/s]; its position stays fixed
};

/// Motion of a rigid body in the fluid; vectors in world components.
struct BodyMotion {
  base::Pose pose;                               ///< pose of the body's frame at the end of the step
  base::Vec3d velocity, spin;                    ///< velocity of the origin and spin over the step [m/s], [rad/s]
  base::Vec3d acceleration, angularAcceleration; ///< acceleration, used to extrapolate wall pressures [m/s2], [rad/s2]
};

/// Rigid body in the fluid; its markers move with it.
struct FluidBody {
  std::string name;                 ///< name in messages
  std::vector<base::Vec3d> markers; ///< positions in the body's frame [m]
  BodyMotion start;
  /// true: the surface touches other bodies, as wheels and shoes do. A particle between two surfaces in contact is
  /// half a spacing from the markers of both, and would be squeezed out at the speed of sound. Therefore its markers
  /// do not repel particles, their pressure ignores the body's acceleration (noisy in impacts), and the compression of
  /// particles beside them is limited to kPinchedCompression.
  bool touches = false;
};

struct FluidSetup {
  FluidModel model;
  base::Vec3d periodLow{}, periodHigh{}; ///< periodic boundaries along x and y, if high > low [m]
  std::vector<FluidParticle> particles;
  std::vector<WallMarker> markers; ///< markers of fixed walls
  std::vector<FluidBody> bodies;
  /// Threshold of div r [-] below which particles are not shifted, as at free surfaces: in three dimensions 2.5 for 1.3
  /// spacings. 0: fluid without free surfaces.
  double surfaceDivergence = 0;
};

} // namespace grouser::fluid
