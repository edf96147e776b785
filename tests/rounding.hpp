// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

namespace grouser::test {

/// The spacing of doubles at 1; tolerances of rounding are multiples of it.
inline constexpr double kEps = std::numeric_limits<double>::epsilon();

} // namespace grouser::test
