// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/bits.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

/// Elementary functions with bitwise identical results on every processor, composed only of + - * / and sqrt in a fixed
/// order. Results of C libraries differ between processors (fused multiply-add is selected at run time). Accuracy: a
/// few units in the last place over the stated ranges, as measured in tests/base/arithmetic_test.cu.
namespace grouser::base {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(); ///< marks values that were not measured

namespace detail {

/// Taylor sine and cosine for |r| <= pi/4.
GROUSER_HD double sinSmall(double r) {
  const double s = r * r;
  double p = -1.0 / 121645100408832000.0;
  p = p * s + 1.0 / 355687428096000.0;
  p = p * s - 1.0 / 1307674368000.0;
  p = p * s + 1.0 / 6227020800.0;
  p = p * s - 1.0 / 39916800.0;
  p = p * s + 1.0 / 362880.0;
  p = p * s - 1.0 / 5040.0;
  p = p * s + 1.0 / 120.0;
  p = p * s - 1.0 / 6.0;
  return r + r * (s * p);
}
GROUSER_HD double cosSmall(double r) {
  const double s = r * r;
  double p = 1.0 / 6402373705728000.0;
  p = -p * s + 1.0 / 20922789888000.0;
  p = p * s - 1.0 / 87178291200.0;
  p = p * s + 1.0 / 479001600.0;
  p = p * s - 1.0 / 3628800.0;
  p = p * s + 1.0 / 40320.0;
  p = p * s - 1.0 / 720.0;
  p = p * s + 1.0 / 24.0;
  p = p * s - 0.5;
  return 1.0 + s * p;
}

/// Cody-Waite reduction: x = k pi/2 + r.
GROUSER_HD double reduceHalfPi(double x, std::int64_t& k) {
  const double n = floor(x * (2.0 / kPi) + 0.5);
  k = static_cast<std::int64_t>(n);
  double r = x - n * 1.57079632673412561417e+00;
  r -= n * 6.07710050630396597660e-11;
  r -= n * 2.02226624879595063154e-21;
  return r;
}

} // namespace detail

/// Sine of `x` [rad], |x| <= 1e6.
GROUSER_HD double sin(double x) {
  std::int64_t k;
  const double r = detail::reduceHalfPi(x, k);
  const double v = (k & 1) ? detail::cosSmall(r) : detail::sinSmall(r);
  return (k & 2) ? -v : v;
}

/// Cosine of `x` [rad], |x| <= 1e6.
GROUSER_HD double cos(double x) {
  std::int64_t k;
  const double r = detail::reduceHalfPi(x, k);
  const double v = (k & 1) ? detail::sinSmall(r) : detail::cosSmall(r);
  return ((k + 1) & 2) ? -v : v;
}

GROUSER_HD double tan(double x) { return base::sin(x) / base::cos(x); }

/// Arc tangent [rad].
GROUSER_HD double atan(double x) {
  double a = x < 0 ? -x : x;
  const bool inverted = a > 1;
  if (inverted) a = 1 / a;
  // Halve the angle twice: |a| <= 0.1989.
  a = a / (1 + ::sqrt(1 + a * a));
  a = a / (1 + ::sqrt(1 + a * a));
  const double s = a * a;
  double p = 0;
  for (int n = 25; n >= 3; n -= 2) p = (((n & 2) ? -1.0 : 1.0) / n + p) * s;
  double r = 4 * (a + a * p);
  if (inverted) r = kPi / 2 - r;
  return x < 0 ? -r : r;
}

/// Angle of the point (x, y) [rad], in (-pi, pi].
GROUSER_HD double atan2(double y, double x) {
  if (x == 0 && y == 0) return 0;
  const double ax = x < 0 ? -x : x, ay = y < 0 ? -y : y;
  double a = ax >= ay ? base::atan(ay / ax) : kPi / 2 - base::atan(ax / ay);
  if (x < 0) a = kPi - a;
  return y < 0 ? -a : a;
}

/// Arc sine [rad], |x| <= 1.
GROUSER_HD double asin(double x) { return base::atan2(x, ::sqrt((1 - x) * (1 + x))); }

/// e^x, |x| <= 700.
GROUSER_HD double exp(double x) {
  const double n = floor(x * 1.44269504088896340736 + 0.5);
  const double r = (x - n * 6.93147180369123816490e-01) - n * 1.90821492927058770002e-10;
  double p = 1;
  for (int k = 16; k >= 1; --k) p = 1 + p * r / k;
  return p * bitsAs<double>(static_cast<std::uint64_t>(static_cast<std::int64_t>(n) + 1023) << 52);
}

/// Natural logarithm of a normal number x > 0.
GROUSER_HD double log(double x) {
  const std::uint64_t bits = bitsAs<std::uint64_t>(x);
  std::int64_t e = static_cast<std::int64_t>(bits >> 52) - 1023;
  double m = bitsAs<double>((bits & 0xFFFFFFFFFFFFFull) | 0x3FF0000000000000ull);
  if (m > 1.41421356237309504880) m *= 0.5, ++e;
  const double s = (m - 1) / (m + 1), s2 = s * s;
  double p = 0;
  for (int n = 25; n >= 3; n -= 2) p = (1.0 / n + p) * s2;
  const double n = static_cast<double>(e);
  return n * 6.93147180369123816490e-01 + (2 * (s + s * p) + n * 1.90821492927058770002e-10);
}

/// Cube root of x >= 0; 0 for x < 0. Halley's method, with a third of the exponent as initial guess (3 % error).
GROUSER_HD double cubeRoot(double x) {
  if (!(x > 0)) return 0;
  double y = bitsAs<double>(bitsAs<std::uint64_t>(x) / 3 + 0x2A9F7893782DA1CEull);
  for (int k = 0; k < 3; ++k) {
    const double cube = y * y * y;
    y = y * ((cube + x + x) / (cube + cube + x));
  }
  return y;
}
/// Cube root of floats, scalar or SIMD; `Bits` is the integer type of the same size.
template <class Bits, class Float> GROUSER_HD Float cubeRootBy(const Float& x) {
  // Use 1 if the result is 0: the cube of the guess would be a denormal number, which is slow.
  Float y = x > 0 ? bitsAs<Float>(bitsAs<Bits>(x) / 3 + 0x2A512CE3u) : Float{} + 1;
  for (int k = 0; k < 2; ++k) {
    const Float cube = y * y * y;
    y = y * ((cube + x + x) / (cube + cube + x));
  }
  return x > 0 ? y : Float{};
}
GROUSER_HD float cubeRoot(float x) { return cubeRootBy<std::uint32_t>(x); }

/// x^y for x > 0.
GROUSER_HD double pow(double x, double y) { return base::exp(y * base::log(x)); }

} // namespace grouser::base
