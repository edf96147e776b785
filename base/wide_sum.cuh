// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/host_device.hpp"

#include <cstdint>

#if defined(__CUDACC__)
#include <cooperative_groups.h>
#include <cooperative_groups/reduce.h>
#endif

namespace grouser::base {

/// An order-free sum of 64-bit integers that does not overflow: two's complement in 128 bits.
struct alignas(16) WideSum {
  std::uint64_t low{};
  std::int64_t high{};

  WideSum& operator+=(const WideSum& other) {
    low += other.low;
    high += other.high + (low < other.low ? 1 : 0);
    return *this;
  }
  /// Rounded once.
  double value() const {
    __extension__ using Wide = __int128;
    return static_cast<double>(static_cast<Wide>(high) * (static_cast<Wide>(1) << 64) + static_cast<Wide>(low));
  }
  bool operator==(const WideSum&) const = default;
};

/// Adds to a sum that threads share.
GROUSER_HD void atomicAddWide(WideSum* sum, std::int64_t value) {
  const auto addend = static_cast<std::uint64_t>(value);
#if defined(__CUDA_ARCH__)
  const std::uint64_t old =
      ::atomicAdd(reinterpret_cast<unsigned long long*>(&sum->low), static_cast<unsigned long long>(addend));
#else
  const std::uint64_t old = __atomic_fetch_add(&sum->low, addend, __ATOMIC_RELAXED);
#endif
  const std::int64_t carry = (value < 0 ? -1 : 0) + (old + addend < old ? 1 : 0);
  if (carry == 0) return;
#if defined(__CUDA_ARCH__)
  ::atomicAdd(reinterpret_cast<unsigned long long*>(&sum->high), static_cast<unsigned long long>(carry));
#else
  __atomic_fetch_add(&sum->high, carry, __ATOMIC_RELAXED);
#endif
}

#if defined(__CUDACC__)
/// The same for the threads of a warp together, those that are here: `kCount` sums side by side.
template <int kCount> __device__ inline void atomicAddTogether(WideSum* sums, const std::int64_t (&values)[kCount]) {
  const auto threads = cooperative_groups::coalesced_threads();
  for (int k = 0; k < kCount; ++k) {
    const long long sum =
        cooperative_groups::reduce(threads, static_cast<long long>(values[k]), cooperative_groups::plus<long long>());
    if (threads.thread_rank() == 0 && sum != 0) atomicAddWide(sums + k, sum);
  }
}
#endif

} // namespace grouser::base
