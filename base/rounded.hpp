// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::base {

/// Rounds a limit for printing to `digits` significant digits (1 to 17): `roundedDown` to the nearest decimal number
/// not above `value`, so that the printed upper limit is valid; `roundedUp` to the nearest not below.
std::string roundedDown(double value, int digits);
std::string roundedUp(double value, int digits);

/// Rounds to 15 significant digits for printing: 5900 steps of 1e-4 s are 0.59 s instead of the floating-point product
/// 0.5900000000000001.
double nearestDecimal(double value);

} // namespace grouser::base
