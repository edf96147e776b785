// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "fluid/fluid.hpp"
#include "fluid/lattice.hpp"
#include "tests/device_under_test.hpp"

#include <algorithm>
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

/// A cube of 8 spacings, held under water: markers on its own lattice, rotated about z.
inline FluidSetup cubeInWater(double turn) {
  FluidSetup s;
  FluidModel& m = s.model = water(3, 0.05);
  m.gravity = {0, 0, -kGravity};
  m.soundSpeed = soundSpeedFor(std::sqrt(2 * kGravity * 0.8), 0, m.density);
  m.timeStep = stepLimits(m, 0.1 * m.soundSpeed, kGravity).least();
  const base::Vec3d low{-0.2, -0.2, -0.2}, high{1.2, 1.2, 1.1}, half{0.2, 0.2, 0.2};
  const base::Pose pose{{0.5, 0.5, 0.4}, {std::cos(turn / 2), 0, 0, std::sin(turn / 2)}};
  const Distance walls = tank({0, 0, 0}, {1, 1, 1.1});
  const Distance free = [&](const base::Vec3d& p) {
    const base::Vec3d q = pose.toBody(p);
    const double out = std::max({std::abs(q.x) - half.x, std::abs(q.y) - half.y, std::abs(q.z) - half.z});
    return std::min(walls(p), out - 0.0249);
  };
  s.markers = wallMarkers(m, walls, low, high);
  s.particles = stillFluid(m, free, low, high, 0.8);
  FluidBody cube{"cube", {}, {pose, {}, {}, {}, {}}, false};
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      for (int k = 0; k < 8; ++k)
        if (std::min({i, j, k}) < 3 || std::max({i, j, k}) > 4)
          cube.markers.push_back({(i - 3.5) * 0.05, (j - 3.5) * 0.05, (k - 3.5) * 0.05});
  s.bodies.push_back(cube);
  return s;
}

} // namespace grouser::fluid
