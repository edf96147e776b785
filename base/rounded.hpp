// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::base {

/// Rounds a limit for printing to `digits` significant digits (1 to 17), down to the nearest decimal number not above
/// `value`, so that the printed limit is safe to use; `roundedUp` rounds up.
std::string roundedDown(double value, int digits);
std::string roundedUp(double value, int digits);

/// Rounds to 15 significant digits for printing: 0.59 s for 5900 steps of 1e-4 s, whose floating-point product is
/// 0.5900000000000001.
double nearestDecimal(double value);

} // namespace grouser::base
