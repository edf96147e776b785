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

/// Order-free sums: a real number becomes a 64-bit multiple of a quantum, a power of two, so that additions are exact
/// and any order, thread count or number of ranks gives the same bits.
///
/// Range: a sum is right while it and every addend stay within +-2^62 quanta. `fixedPointFor(largest, bits)` leaves
/// room for 2^(62 - bits) addends of the largest size; a single one beyond 2^62 becomes the end of the range, on every
/// device, and so shows in the sum. `checked()` tells a sum that has left its range from one that has not.
struct FixedPoint {
  double quantum{1};
  double perUnit{1}; ///< 1 / quantum, exact

  /// Nearest multiple; what is beyond the range (or no number) becomes its end, on every device.
  GROUSER_HD std::int64_t quantise(double value) const {
    constexpr double kMost = 4611686018427387904.0; // 2^62
    const double quanta = floor(value * perUnit + 0.5);
    return static_cast<std::int64_t>(!(quanta > -kMost) ? -kMost : quanta < kMost ? quanta : kMost);
  }
  GROUSER_HD double value(std::int64_t quanta) const { return static_cast<double>(quanta) * quantum; }
  /// The sum of what was quantised. Throws SimulationError where it has left the range; `what` says what was summed.
  double checked(std::int64_t quanta, const char* what) const {
    constexpr std::int64_t kEnd = std::int64_t{1} << 62;
    if (quanta >= kEnd || quanta <= -kEnd)
      throw SimulationError(std::string("the sum of ") + what +
                            " has left the range of its 64-bit integer: the scene has become unsound, or its numbers "
                            "are too unlike for one run");
    return value(quanta);
  }
  Vec3d checked(const Vec3l& q, const char* what) const {
    return {checked(q.x, what), checked(q.y, what), checked(q.z, what)};
  }
  GROUSER_HD Vec3l quantise(const Vec3d& v) const { return {quantise(v.x), quantise(v.y), quantise(v.z)}; }
  GROUSER_HD Vec3d value(const Vec3l& q) const { return {value(q.x), value(q.y), value(q.z)}; }
};

/// The quantum under which `largest` takes at most 2^bits quanta, and more than half as many but where it lies below
/// 2^(bits - 1022), for quanta and their inverse are normal numbers: room for 2^(62 - bits) addends of that size.
/// Throws SimulationError where `largest` is not above 0 and finite.
inline FixedPoint fixedPointFor(double largest, int bits = 42) {
  if (!(largest > 0 && largest <= std::numeric_limits<double>::max()))
    throw SimulationError("sums of numbers up to " + std::to_string(largest) +
                          " have no scale: what they follow from (stiffness, mass, size, gravity) is too small or too "
                          "large for one run");
  int exponent = 0;
  std::frexp(largest, &exponent);
  const int finer = std::clamp(bits - exponent, -1022, 1022);
  return {std::ldexp(1.0, -finer), std::ldexp(1.0, finer)};
}

} // namespace grouser::base
