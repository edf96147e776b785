// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "contact/restitution.hpp"
#include "terrain/grains.hpp"

#include <cmath>

namespace grouser::terrain::testing {

/// The reference ball of the closed forms: R = 5 mm, 2600 kg/m3, k = 1e5 N/m.
inline GrainModel ball(double timeStep) {
  GrainModel m;
  m.radius = 0.005;
  m.mass = 2600 * 4.0 / 3.0 * base::kPi * m.radius * m.radius * m.radius;
  m.timeStep = timeStep;
  m.law.stiffness = 1e5f;
  m.skin = 0.5;
  return m;
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
