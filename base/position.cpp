// SPDX-License-Identifier: BSD-3-Clause
#include "base/position.hpp"

namespace grouser::base {

PositionScale positionScale(double diameter) {
  constexpr double kMax = 0x1p1000; // doubles overflow for larger values
  PositionScale scale;
  while (diameter * scale.perMetre < 1e8 && scale.perMetre < kMax) scale.perMetre *= 2, scale.unit /= 2;
  while (diameter * scale.perMetre >= 2e8) scale.perMetre /= 2, scale.unit *= 2;
  return scale;
}

} // namespace grouser::base
