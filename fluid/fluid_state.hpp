// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstdint>
#include <vector>

namespace grouser::fluid {

/// Work per mass that a particle has lost since the start [J/kg]. Markers store no energy: the work of their pressure
/// beyond the compression of the fluid is the loss to walls.
struct Losses {
  double viscous, diffusion, wall;
};

/// Force [N] and torque about the origin of a body's frame [N m], world components.
struct BodyLoad {
  base::Vec3d force, torque;
};

/// A particle between two steps.
struct SavedParticle {
  base::Vec3d position, velocity; ///< [m], [m/s]
  double compression;             ///< [-]
  base::Vec3d acceleration;       ///< by pair terms, whole quanta [m/s2]
  Losses losses;                  ///< since the start [J/kg]
};

/// State that later steps of a fluid depend on, and its losses.
struct FluidState {
  std::int64_t steps{};
  std::vector<SavedParticle> particles; ///< in the order of FluidSetup
  std::vector<base::Vec3l> bodyLoads;   ///< force and torque of each body [quanta]
};

} // namespace grouser::fluid
