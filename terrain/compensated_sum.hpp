// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/bits.hpp"
#include "base/position.hpp"

#include <cmath>
#include <cstdint>

/// Sums over many steps without accumulated rounding errors: `v += g dt` in single precision has an error of 2 % of g
/// at a step of 1e-6 s, because every step rounds in the same direction.
namespace grouser::terrain {

/// Rounding remainders of one grain: per axis 16 bits for velocity and 16 for spin; 3 x 10 bits for position.
struct alignas(16) Remainders {
  std::uint32_t axis[3];
  std::uint32_t position;
};

/// Quantum of a velocity remainder, relative to the power of two below |v|.
inline constexpr double kRemainderOfBinade = 0x1p-39;
/// Lower limit 2^-100 of |v|, as float bits; smaller values are irrelevant.
inline constexpr std::int32_t kMinBinade = 27 << 23;
inline constexpr int kMinRemainder = -32768, kMaxRemainder = 32767;
/// Quanta of a position remainder per position unit, and its range.
inline constexpr int kPlacesPerUnit = 1024, kMinPlace = -512, kMaxPlace = 511;
/// Displacement per step [units] that raises a speed fault, before conversion to an integer.
inline constexpr double kMaxUnitsPerStep = 1e9;

/// Float bits of the power of two below |v|.
GROUSER_HD std::int32_t binadeOf(float v) {
  const std::int32_t bits = base::bitsAs<std::int32_t>(v) & 0x7F800000;
  return bits < kMinBinade ? kMinBinade : bits;
}

/// Quantum of a velocity remainder: 2^-39 of the power of two below |v|, i.e. 2^-16 of the float's last place.
GROUSER_HD double remainderQuantum(float v) {
  return static_cast<double>(base::bitsAs<float>(binadeOf(v))) * kRemainderOfBinade;
}
/// Inverse of remainderQuantum().
GROUSER_HD double perRemainderQuantum(float v) {
  return static_cast<double>(base::bitsAs<float>((254 << 23) - binadeOf(v))) * (1 / kRemainderOfBinade);
}

/// Returns the value plus its remainder.
GROUSER_HD double withRemainder(float value, std::int16_t remainder) {
  return static_cast<double>(value) + remainder * remainderQuantum(value);
}

/// New sum in double, and the excess of the stored value with remainder over it; both exact.
struct CompensatedStep {
  double sum, rounding;
};

/// Computes value + remainder += increment.
GROUSER_HD CompensatedStep addCompensated(float& value, std::int16_t& remainder, double increment) {
  const double sum = withRemainder(value, remainder) + increment;
  value = static_cast<float>(sum);
  // Dividing by a power of two equals multiplying by its inverse, bit for bit.
  const double rest = (sum - static_cast<double>(value)) * perRemainderQuantum(value);
  double r = floor(rest + 0.5);
  r = r > kMaxRemainder ? kMaxRemainder : r < kMinRemainder ? kMinRemainder : r;
  remainder = static_cast<std::int16_t>(r);
  return {sum, (r - rest) * remainderQuantum(value)};
}

GROUSER_HD std::int16_t lowRemainder(std::uint32_t word) { return static_cast<std::int16_t>(word & 0xFFFFu); }
GROUSER_HD std::int16_t highRemainder(std::uint32_t word) { return static_cast<std::int16_t>(word >> 16); }
GROUSER_HD std::uint32_t packRemainders(std::int16_t low, std::int16_t high) {
  return static_cast<std::uint32_t>(static_cast<std::uint16_t>(low)) |
         static_cast<std::uint32_t>(static_cast<std::uint16_t>(high)) << 16;
}

/// Remainder stored by advanceKeeping() for an axis [units].
GROUSER_HD double placesKept(std::uint32_t word, int axis) {
  return (static_cast<std::int32_t>(word << (22 - 10 * axis)) >> 22) * (1.0 / kPlacesPerUnit);
}

/// Returns the whole units of a displacement [units]; stores the rest, in 1/1024 units, in 10 bits of `word`.
GROUSER_HD std::int64_t advanceKeeping(double displacement, std::uint32_t& word, int axis) {
  const double wanted = displacement + placesKept(word, axis);
  const double whole = floor(wanted + 0.5);
  double r = floor((wanted - whole) * kPlacesPerUnit + 0.5);
  r = r > kMaxPlace ? kMaxPlace : r < kMinPlace ? kMinPlace : r;
  word &= ~(0x3FFu << 10 * axis);
  word |= (static_cast<std::uint32_t>(static_cast<std::int32_t>(r)) & 0x3FFu) << 10 * axis;
  return static_cast<std::int64_t>(whole);
}

} // namespace grouser::terrain
