// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace grouser::bench {

/// Two spheres that touch, by their places in the array of positions.
struct IdPair {
  std::uint32_t first, second; ///< first < second
};

} // namespace grouser::bench
