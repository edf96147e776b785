// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::base {

/// A limit as one prints it, with so many significant digits: the nearest decimal number that is not above `value`, so
/// that who takes it at its word keeps the limit; `roundedUp` not below it. `digits`: 1 to 17.
std::string roundedDown(double value, int digits);
std::string roundedUp(double value, int digits);

/// The nearest number of 15 significant digits, for what a reader meets: 0.59 s for 5900 steps of 1e-4 s, whose product
/// is 0.5900000000000001.
double nearestDecimal(double value);

} // namespace grouser::base
