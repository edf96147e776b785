// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstdint>
#include <vector>

namespace grouser::fluid {

/// Work per mass dissipated by a particle since the start [J/kg]. Markers store no energy: the loss to walls is the
/// work of the marker pressure in excess of the fluid's compression energy.
struct Losses {
  double viscous, diffusion, wall;
};

/// Force [N] and torque about the origin of the body frame [N m], world components.
struct BodyLoad {
  base::Vec3d force, torque;
};

/// Particle state between two steps.
struct SavedParticle {
  base::Vec3d position, velocity; ///< [m], [m/s]
  double compression;             ///< [-]
  base::Vec3d acceleration;       ///< pair terms, whole quanta [m/s2]
  Losses losses;                  ///< since the start [J/kg]
};

/// State of a fluid that later steps depend on, with its losses.
struct FluidState {
  std::int64_t steps{};
  std::vector<SavedParticle> particles; ///< in the order of FluidSetup
  std::vector<base::Vec3l> bodyLoads;   ///< force and torque of each body [quanta]
};

} // namespace grouser::fluid
