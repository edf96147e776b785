// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/host_device.hpp"

#include <cstdint>

namespace grouser::base {

/// Order-independent 128-bit sum (two's complement) of 64-bit integers; does not overflow.
struct alignas(16) WideSum {
  std::uint64_t low{};
  std::int64_t high{};

  GROUSER_HD WideSum& operator+=(const WideSum& other) {
    low += other.low;
    high += other.high + (low < other.low ? 1 : 0);
    return *this;
  }
  /// Returns the sum as a double, rounded once.
  double value() const {
    __extension__ using Wide = __int128;
    return static_cast<double>(static_cast<Wide>(high) * (static_cast<Wide>(1) << 64) + static_cast<Wide>(low));
  }
  /// Returns the sum as a double, rounded once if it fits into 64 bits; identical on every device.
  GROUSER_HD double toDouble() const {
    const auto small = static_cast<std::int64_t>(low);
    if (high == (small < 0 ? -1 : 0)) return static_cast<double>(small);
    return static_cast<double>(high) * 0x1p64 + static_cast<double>(low);
  }
  bool operator==(const WideSum&) const = default;
};

/// Atomically adds `value` to a sum shared by threads.
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
namespace detail {
/// Stores in values[0] the sum over the warp of the value with index lane / (32 / kCount). Each exchange halves the
/// number of values per lane.
template <int kCount> __device__ inline void reduceScatter(std::int64_t* values, unsigned lane, unsigned apart = 16) {
  if constexpr (kCount > 1) {
    constexpr int kHalf = kCount / 2;
    const bool upper = lane & apart;
    for (int k = 0; k < kHalf; ++k) {
      const std::int64_t sent = upper ? values[k] : values[k + kHalf];
      values[k] = (upper ? values[k + kHalf] : values[k]) + __shfl_xor_sync(~0u, sent, static_cast<int>(apart));
    }
    reduceScatter<kHalf>(values, lane, apart / 2);
  } else {
    for (; apart > 0; apart /= 2) values[0] += __shfl_xor_sync(~0u, values[0], static_cast<int>(apart));
  }
}
} // namespace detail

/// Adds `kCount` values per thread to `kCount` sums, like atomicAddWide(). A complete warp adds its total once; since
/// values are below 2^58, the sum of 32 values does not overflow.
template <int kCount> __device__ inline void atomicAddTogether(WideSum* sums, const std::int64_t (&values)[kCount]) {
  static_assert(kCount <= 32);
  if (__activemask() == ~0u) {
    constexpr int kPadded = kCount > 16 ? 32 : kCount > 8 ? 16 : kCount > 4 ? 8 : kCount > 2 ? 4 : kCount;
    constexpr unsigned kLanes = 32 / kPadded; // lanes per total
    const unsigned lane = threadIdx.x % 32;
    std::int64_t all[kPadded] = {};
    for (int k = 0; k < kCount; ++k) all[k] = values[k];
    detail::reduceScatter<kPadded>(all, lane);
    if (lane % kLanes == 0 && lane / kLanes < kCount && all[0] != 0) atomicAddWide(sums + lane / kLanes, all[0]);
    return;
  }
  std::int64_t own[kCount]; // local copy, so that `values` stays in registers
  for (int k = 0; k < kCount; ++k) own[k] = values[k];
#pragma unroll 1
  for (int k = 0; k < kCount; ++k)
    if (own[k] != 0) atomicAddWide(sums + k, own[k]);
}
#endif

} // namespace grouser::base
