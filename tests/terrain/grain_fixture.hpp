// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "contact/restitution.hpp"
#include "terrain/grains.hpp"

#include <cmath>
#include <vector>

namespace grouser::terrain::testing {

inline double sphereMass(double density, double radius) {
  return density * 4.0 / 3.0 * base::kPi * radius * radius * radius;
}

/// The reference ball of the closed forms: R = 5 mm, 2600 kg/m3, k = 1e5 N/m.
inline GrainModel ball(double timeStep) {
  GrainModel m;
  m.radius = 0.005;
  m.mass = sphereMass(2600, m.radius);
  m.timeStep = timeStep;
  m.law.stiffness = 1e5f;
  m.skin = 0.5;
  return m;
}

/// Adds damping and friction to a linear `law`, with tangential springs of 2/7 and dashpots of half the normal ones.
inline void makeRough(contact::ContactLaw& law, double damping, double friction = 0.5) {
  law.damping = damping, law.friction = friction;
  law.tangentialStiffness = law.stiffness * 2 / 7, law.tangentialDamping = 0.5 * damping;
}

/// The reference ball, heavy and rough, with damping ratio `zeta` [-] on rigid surfaces.
inline GrainModel roughBall(double timeStep, double friction, double zeta) {
  GrainModel m = ball(timeStep);
  m.gravity = {0, 0, -9.81};
  makeRough(m.law, 2 * zeta * std::sqrt(m.law.stiffness / m.mass), friction);
  return m;
}

/// Rough grains as in beds for vehicles: R = 27 mm, 2500 kg/m3, k = 1e6 N/m.
inline GrainModel gravel(double skin = 0.3) {
  GrainModel m;
  m.radius = 0.027;
  m.mass = sphereMass(2500, m.radius);
  m.timeStep = 5e-5;
  m.gravity = {0, 0, -9.81};
  m.law.stiffness = 1e6f;
  makeRough(m.law, 1500);
  m.skin = skin;
  return m;
}

/// A block of gravel without aligned columns, with one velocity and spin.
inline std::vector<GrainSpec> gravelBlock(int across, int deep, int layers, const base::Vec3d& velocity,
                                          const base::Vec3d& spin = {}, const base::Vec3d& shift = {}) {
  std::vector<GrainSpec> start;
  for (int z = 0; z < layers; ++z)
    for (int y = 0; y < deep; ++y)
      for (int x = 0; x < across; ++x) {
        const double odd = z % 2 ? 0.011 : 0.0, wobble = 0.001 * ((x * 7 + y * 5 + z * 3) % 4);
        start.push_back(
            {shift + base::Vec3d{0.0575 * x + odd + wobble, 0.0575 * y - odd, 0.03 + 0.0575 * z}, velocity, spin});
      }
  return start;
}

inline Wall floorPlane(const contact::ContactLaw& law) { return {{0, 0, 1}, 0.0, law}; }

/// Steps `n` times, rebuilding as needed.
inline void advance(Grains& grains, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) {
    grains.refreshNeighbours();
    grains.step();
  }
}

} // namespace grouser::terrain::testing
