// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

namespace grouser::test {

/// The spacing of doubles at 1, of which tolerances of rounding are multiples.
inline constexpr double kEps = std::numeric_limits<double>::epsilon();

} // namespace grouser::test
