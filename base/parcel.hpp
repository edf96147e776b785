// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace grouser::base {

/// A copy of memory, or of zeros, to device memory or pinned host memory.
struct Parcel {
  void* to;
  const void* from;  ///< null: writes zeros
  std::size_t bytes; ///< a multiple of 8
};

/// Sixteen bytes of device memory; if they differ from their normal values, the work is cancelled.
struct Watch {
  const void* at = nullptr; ///< null: never cancels
  std::uint64_t idle[2] = {0, 0};
};

constexpr std::size_t kMaxParcels = 4;

} // namespace grouser::base
