// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"

namespace grouser::base {

/// Mass of a sphere [kg]. The last bits of a bed's state follow from this order of factors.
constexpr double sphereMass(double density, double radius) {
  return density * (4.0 / 3.0) * kPi * radius * radius * radius;
}
constexpr double sphereVolume(double radius) { return sphereMass(1, radius); } ///< [m3]

} // namespace grouser::base
