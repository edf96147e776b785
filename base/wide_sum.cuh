// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/host_device.hpp"

#include <cstdint>

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
/// The same for the threads of a warp together, those that are here: `kCount` sums side by side. The processor sums 32
/// bits at once, so the numbers go in limbs of 26: two for numbers below 2^51, three for all below 2^63.
template <int kLimbs, int kCount>
__device__ inline void atomicAddTogether(WideSum* sums, const std::int64_t (&values)[kCount]) {
#if __CUDA_ARCH__ >= 800
  constexpr int kBits = 26;
  constexpr std::int64_t kMask = (std::int64_t{1} << kBits) - 1;
  const unsigned here = __activemask();
  const int threads = __popc(here), own = __popc(here & ((1u << (threadIdx.x & 31u)) - 1));
  // A thread adds one of the sums: one after the other they would each wait for memory.
  std::int64_t mine = 0;
  for (int k = 0; k < kCount; ++k) {
    std::int64_t sum = __reduce_add_sync(here, static_cast<int>(values[k] >> kBits * (kLimbs - 1))); // with the sign
    for (int limb = kLimbs - 2; limb >= 0; --limb)
      sum = (sum << kBits) + __reduce_add_sync(here, static_cast<unsigned>(values[k] >> kBits * limb & kMask));
    if (k == own) mine = sum;
    if (k >= threads && own == 0) atomicAddWide(sums + k, sum); // more sums than threads
  }
  if (own < kCount && mine != 0) atomicAddWide(sums + own, mine);
#else
  for (int k = 0; k < kCount; ++k)
    if (values[k] != 0) atomicAddWide(sums + k, values[k]);
#endif
}
#endif

} // namespace grouser::base
