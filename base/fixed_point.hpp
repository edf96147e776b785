// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"
#include "base/vec.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

namespace grouser::base {

/// Fixed-point format for order-independent sums: a real number becomes a 64-bit multiple of a quantum (a power of
/// two), so additions are exact and the sum has the same bits for any order, thread count or number of ranks.
///
/// Range: a sum is correct if the sum and every addend are within +-2^62 quanta. `fixedPointFor(largest, bits)` allows
/// 2^(62 - bits) addends of size `largest`. Addends out of range are clamped to its end, on every device. `checked()`
/// detects sums out of range.
struct FixedPoint {
  double quantum{1};
  double perUnit{1}; ///< 1 / quantum, exact

  /// Rounds to the nearest multiple; clamps NaN and values beyond the range to its end, on every device.
  GROUSER_HD std::int64_t quantise(double value) const {
    constexpr double kMax = 4611686018427387904.0; // 2^62
    const double quanta = floor(value * perUnit + 0.5);
    return static_cast<std::int64_t>(!(quanta > -kMax) ? -kMax : quanta < kMax ? quanta : kMax);
  }
  GROUSER_HD double value(std::int64_t quanta) const { return static_cast<double>(quanta) * quantum; }
  /// Returns the value of a sum. Throws SimulationError if it is out of range; `what` names the summed quantity.
  double checked(std::int64_t quanta, const char* what) const {
    constexpr std::int64_t kEnd = std::int64_t{1} << 62;
    if (quanta >= kEnd || quanta <= -kEnd)
      throw SimulationError(std::string("the sum of ") + what +
                            " overflows a 64-bit integer: the run is unstable, or values of the scene differ by too "
                            "many orders of magnitude; reduce the time step, or check stiffness, mass and size");
    return value(quanta);
  }
  Vec3d checked(const Vec3l& q, const char* what) const {
    return {checked(q.x, what), checked(q.y, what), checked(q.z, what)};
  }
  GROUSER_HD Vec3l quantise(const Vec3d& v) const { return {quantise(v.x), quantise(v.y), quantise(v.z)}; }
  GROUSER_HD Vec3d value(const Vec3l& q) const { return {value(q.x), value(q.y), value(q.z)}; }
};

/// Returns the format in which `largest` is between 2^(bits - 1) and 2^bits quanta; fewer if `largest` is below
/// 2^(bits - 1022), since the quantum and its inverse must be normal numbers. Sums can have 2^(62 - bits) addends of
/// this size. Throws SimulationError unless `largest` is positive and finite.
inline FixedPoint fixedPointFor(double largest, int bits = 42) {
  if (!(largest > 0 && largest <= std::numeric_limits<double>::max()))
    throw SimulationError(
        "no fixed-point scale for sums of values up to " + std::to_string(largest) +
        ": stiffness, mass, size or gravity of the scene is too small or too large; correct the value");
  int exponent = 0;
  std::frexp(largest, &exponent);
  const int finer = std::clamp(bits - exponent, -1022, 1022);
  return {std::ldexp(1.0, -finer), std::ldexp(1.0, finer)};
}

} // namespace grouser::base
