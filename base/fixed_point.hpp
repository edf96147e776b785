// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cmath>
#include <cstdint>

namespace grouser::base {

/// Order-free sums: a real number becomes a 64-bit multiple of a quantum, a power of two, so that additions are exact
/// and any order, thread count or number of ranks gives the same bits. The range is +-2^63 quanta.
struct FixedPoint {
  double quantum{1};
  double perUnit{1}; ///< 1 / quantum, exact

  /// Nearest multiple; what is beyond half the range (or no number) becomes the end of that half, on every device.
  GROUSER_HD std::int64_t quantise(double value) const {
    constexpr double kMost = 4611686018427387904.0; // 2^62
    const double quanta = floor(value * perUnit + 0.5);
    return static_cast<std::int64_t>(!(quanta > -kMost) ? -kMost : quanta < kMost ? quanta : kMost);
  }
  GROUSER_HD double value(std::int64_t quanta) const { return static_cast<double>(quanta) * quantum; }
  GROUSER_HD Vec3l quantise(const Vec3d& v) const { return {quantise(v.x), quantise(v.y), quantise(v.z)}; }
  GROUSER_HD Vec3d value(const Vec3l& q) const { return {value(q.x), value(q.y), value(q.z)}; }
};

/// The quantum under which `largest` takes 2^bits quanta: room for 2^(63 - bits) addends of that size.
inline FixedPoint fixedPointFor(double largest, int bits = 42) {
  FixedPoint f;
  while (largest * f.perUnit < std::ldexp(1.0, bits - 1)) f.perUnit *= 2, f.quantum /= 2;
  while (largest * f.perUnit >= std::ldexp(1.0, bits)) f.perUnit /= 2, f.quantum *= 2;
  return f;
}

} // namespace grouser::base
