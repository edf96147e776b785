// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace grouser::base {

/// A copy into device or pinned host memory: from other memory, or zeros.
struct Parcel {
  void* to;
  const void* from;  ///< null: zeros
  std::size_t bytes; ///< a multiple of 8
};

/// Sixteen bytes on the device that cancel work if they differ from their normal values.
struct Watch {
  const void* at = nullptr; ///< null: never
  std::uint64_t idle[2] = {0, 0};
};

constexpr std::size_t kMostParcels = 4;

} // namespace grouser::base
