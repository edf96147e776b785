// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/host_device.hpp"

#include <cstdint>
#include <cstring>

namespace grouser::base {

/// Reinterprets the bits as another type of the same size; std::bit_cast is not available on GPUs. Always inlined,
/// because code compiled for specific instruction sets also calls it (base/simd.hpp).
template <class To, class From> GROUSER_HD __attribute__((always_inline)) To bitsAs(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  memcpy(&to, &from, sizeof to);
  return to;
}

/// Index of the lowest set bit; `bits` must not be 0.
GROUSER_HD int lowestBit(std::uint64_t bits) {
#if defined(__CUDA_ARCH__)
  return __ffsll(static_cast<long long>(bits)) - 1;
#else
  return __builtin_ctzll(bits);
#endif
}

/// Number of set bits (population count).
GROUSER_HD std::uint32_t bitsSet(std::uint64_t bits) {
#if defined(__CUDA_ARCH__)
  return static_cast<std::uint32_t>(__popcll(bits));
#else
  return static_cast<std::uint32_t>(__builtin_popcountll(bits));
#endif
}

} // namespace grouser::base
