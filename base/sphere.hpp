// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"

#include <algorithm>

namespace grouser::base {

/// Mass of a sphere [kg]. The order of the factors affects the last bits of the bed state; do not change it.
constexpr double sphereMass(double density, double radius) {
  return density * (4.0 / 3.0) * kPi * radius * radius * radius;
}
constexpr double sphereVolume(double radius) { return sphereMass(1, radius); } ///< [m3]
/// Volume of the part below height h of a sphere with radius r and centre at height z [m3].
constexpr double sphereVolumeBelow(double h, double z, double r) {
  const double cap = std::clamp(h - (z - r), 0.0, 2 * r);
  return kPi * cap * cap * (3 * r - cap) / 3;
}

} // namespace grouser::base
