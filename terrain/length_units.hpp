// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/position.hpp"

#include <cmath>

namespace grouser::terrain {

/// The nearest whole number of units of a length [m].
inline std::int64_t unitsOf(double length, const base::PositionScale& scale) {
  return static_cast<std::int64_t>(std::floor(length * scale.perMetre + 0.5));
}

} // namespace grouser::terrain
