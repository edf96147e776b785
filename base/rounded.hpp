// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::base {

/// A limit for printing, with `digits` significant digits: the nearest decimal number not above `value`, so that the
/// printed limit is safe to use; `roundedUp` not below it. `digits`: 1 to 17.
std::string roundedDown(double value, int digits);
std::string roundedUp(double value, int digits);

/// The nearest number with 15 significant digits, for printing: 0.59 s for 5900 steps of 1e-4 s, whose product is
/// 0.5900000000000001.
double nearestDecimal(double value);

} // namespace grouser::base
