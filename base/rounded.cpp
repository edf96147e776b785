// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounded.hpp"

#include <cmath>
#include <cstdlib>
#include <fmt/format.h>

namespace grouser::base {

namespace {

/// Returns the nearest number with `digits` digits, or its neighbour in the direction `direction`.
std::string rounded(double value, int digits, int direction) {
  const std::string nearest = fmt::format("{:.{}e}", value, digits - 1);
  double number = std::strtod(nearest.c_str(), nullptr);
  if (std::isfinite(value) && (direction < 0 ? number > value : number < value)) {
    // Increment the last digit in integer arithmetic.
    const std::size_t e = nearest.find('e');
    std::string mantissa = nearest.substr(0, e);
    if (const std::size_t point = mantissa.find('.'); point != std::string::npos) mantissa.erase(point, 1);
    long exponent = std::strtol(nearest.c_str() + e + 1, nullptr, 10) - (digits - 1);
    long long whole = std::strtoll(mantissa.c_str(), nullptr, 10), least = 1;
    for (int d = 1; d < digits; ++d) least *= 10;
    const long long sign = whole < 0 ? -1 : 1;
    // A power of ten rounded towards zero has nines in all digits.
    if (whole * sign == least && sign != direction)
      whole = sign * (10 * least - 1), --exponent;
    else
      whole += direction;
    number = std::strtod(fmt::format("{}e{}", whole, exponent).c_str(), nullptr);
  }
  return fmt::format("{:.{}g}", number, digits);
}

} // namespace

std::string roundedDown(double value, int digits) { return rounded(value, digits, -1); }
std::string roundedUp(double value, int digits) { return rounded(value, digits, 1); }

double nearestDecimal(double value) { return std::strtod(fmt::format("{:.15g}", value).c_str(), nullptr); }

} // namespace grouser::base
