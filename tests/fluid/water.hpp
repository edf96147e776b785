// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "fluid/fluid.hpp"
#include "fluid/lattice.hpp"
#include "tests/device_under_test.hpp"

#include <cmath>

namespace grouser::fluid {

inline constexpr double kGravity = 9.81; // [m/s2]

inline FluidModel water(int dimensions, double spacing) {
  FluidModel m;
  m.dimensions = dimensions, m.spacing = spacing, m.soundSpeed = 10, m.timeStep = 1e-4;
  return m;
}

/// Water 10 spacings deep in a tank of 12 x 8 spacings.
inline FluidSetup tankOfWater(double viscosity = 0) {
  FluidSetup s;
  FluidModel& m = s.model = water(3, 0.05);
  m.gravity = {0, 0, -kGravity}, m.viscosity = viscosity;
  m.soundSpeed = soundSpeedFor(std::sqrt(2 * kGravity * 0.5), 0, m.density);
  m.timeStep = stepLimits(m, 0.1 * m.soundSpeed, kGravity).least();
  const base::Vec3d low{-0.2, -0.2, -0.2}, high{0.8, 0.6, 0.9};
  const Distance walls = tank({0, 0, 0}, {0.6, 0.4, 0.9});
  s.markers = wallMarkers(m, walls, low, high);
  s.particles = stillFluid(m, walls, low, high, 0.5);
  return s;
}

/// A column of water that collapses.
inline FluidSetup damBreak() {
  FluidSetup s = tankOfWater(0.5);
  std::erase_if(s.particles, [](const FluidParticle& p) { return p.position.x > 0.25; });
  return s;
}

} // namespace grouser::fluid
