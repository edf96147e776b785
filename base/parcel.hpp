// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace grouser::base {

/// Memory of the device, or pinned on the host, that is to hold what another has, or zeros.
struct Parcel {
  void* to;
  const void* from;  ///< null: zeros
  std::size_t bytes; ///< a multiple of 8
};

/// Sixteen bytes on the device that call work off where they are not as they are while all is well.
struct Watch {
  const void* at = nullptr; ///< null: never
  std::uint64_t idle[2] = {0, 0};
};

constexpr std::size_t kMostParcels = 4;

} // namespace grouser::base
