// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstdint>

namespace grouser::base {

/// Grain position as three 42-bit integers in 16 bytes: the low 32 bits of each axis, then the 10 high bits of each of
/// the three axes.
///
/// The unit is a power of two in metres for which the largest grain diameter is between 1e8 and 2e8 units. For grains
/// less than 2^31 units (about 10 diameters) apart, a wrapping 32-bit subtraction of the low words yields the exact
/// difference, which is antisymmetric, without cell arithmetic or rounding. The range is 2^42 units, i.e. 20,000 to
/// 40,000 diameters.
struct alignas(16) Position {
  std::uint32_t x, y, z, high;
};

/// Signed 42-bit coordinate of one axis [units]; `low` is the low word of this axis.
GROUSER_HD std::int64_t axisOf(std::uint32_t low, std::uint32_t high, int axis) {
  const std::int64_t top = static_cast<std::int32_t>(high << (22 - 10 * axis)) >> 22; // sign-extends 10 bits
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(top) << 32 | low);
}

GROUSER_HD Vec3l toUnits(const Position& p) {
  return {axisOf(p.x, p.high, 0), axisOf(p.y, p.high, 1), axisOf(p.z, p.high, 2)};
}

GROUSER_HD Position fromUnits(const Vec3l& u) {
  const auto high = [](std::int64_t v) {
    return static_cast<std::uint32_t>(static_cast<std::uint64_t>(v) >> 32) & 0x3FFu;
  };
  return {static_cast<std::uint32_t>(u.x), static_cast<std::uint32_t>(u.y), static_cast<std::uint32_t>(u.z),
          high(u.x) | high(u.y) << 10 | high(u.z) << 20};
}

/// b - a [units], exact if the points are less than 2^31 units apart on each axis.
GROUSER_HD Vec3i difference(const Position& a, const Position& b) {
  return {static_cast<std::int32_t>(b.x - a.x), static_cast<std::int32_t>(b.y - a.y),
          static_cast<std::int32_t>(b.z - a.z)};
}

GROUSER_HD std::int64_t squaredNorm(const Vec3i& d) {
  const std::int64_t x = d.x, y = d.y, z = d.z;
  return x * x + y * y + z * z;
}

/// Units of length of a scene.
struct PositionScale {
  double unit{1};     ///< [m], a power of two
  double perMetre{1}; ///< 1 / unit, exact

  GROUSER_HD Vec3d toMetres(const Position& p) const {
    const Vec3l u = toUnits(p);
    return {static_cast<double>(u.x) * unit, static_cast<double>(u.y) * unit, static_cast<double>(u.z) * unit};
  }
  /// Rounds to the nearest grid point. The caller must check `inRange` first.
  GROUSER_HD Position fromMetres(const Vec3d& p) const {
    return fromUnits({static_cast<std::int64_t>(floor(p.x * perMetre + 0.5)),
                      static_cast<std::int64_t>(floor(p.y * perMetre + 0.5)),
                      static_cast<std::int64_t>(floor(p.z * perMetre + 0.5))});
  }
  /// Rounds a length [m] to the nearest whole number of units; it may exceed the range of positions.
  std::int64_t inUnits(double length) const { return static_cast<std::int64_t>(floor(length * perMetre + 0.5)); }
  double limit() const { return 2199023255552.0 * unit; } ///< |coordinate| must stay below this [m]
};

/// Scale for grains of at most `diameter` [m].
PositionScale positionScale(double diameter);

} // namespace grouser::base
