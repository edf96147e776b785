// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "fluid/fluid_model.hpp"

#include <vector>

namespace grouser::fluid {

/// A particle as it starts.
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

struct FluidSetup {
  FluidModel model;
  base::Vec3d periodLow{}, periodHigh{}; ///< periodic boundaries along x and y where high is above low [m]
  std::vector<FluidParticle> particles;
  std::vector<WallMarker> markers;
  /// No shifting where div r falls below this, as at free surfaces: in three dimensions 2.5 for 1.3 spacings. 0: fluid
  /// without free surfaces [-].
  double surfaceDivergence = 0;
};

} // namespace grouser::fluid
