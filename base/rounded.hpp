// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::base {

/// A limit as one prints it, with so many significant digits: the nearest decimal number that is not above `value`, so
/// that who takes it at its word keeps the limit; `roundedUp` not below it. `digits`: 1 to 17.
std::string roundedDown(double value, int digits);
std::string roundedUp(double value, int digits);

} // namespace grouser::base
