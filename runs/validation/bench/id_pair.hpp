// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace grouser::bench {

/// Two spheres in contact, by their indices in the array of positions.
struct IdPair {
  std::uint32_t first, second; ///< first < second
};

} // namespace grouser::bench
