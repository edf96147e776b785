// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/host_device.hpp"

#include <cstdint>
#include <string_view>

/// Counter-based random numbers: pure functions of seed, purpose and id, independent of call order and domain
/// decomposition. Checkpoints therefore contain no generator state.
namespace grouser::base {

namespace detail {

/// Bijective mixer of 64 bits: the finaliser of SplitMix64 (Steele, Lea, Flood 2014; constants of Stafford's variant
/// 13).
GROUSER_HD constexpr std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return z ^ (z >> 31);
}

inline constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ull; ///< 2^64 / golden ratio, the Weyl step of SplitMix64

} // namespace detail

/// Identifier of a random stream, computed from a name such as "terrain.jitter" (FNV-1a). Each purpose has its own.
constexpr std::uint64_t purpose(std::string_view name) {
  std::uint64_t h = 0xCBF29CE484222325ull;
  for (const char c : name) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001B3ull;
  return h;
}

/// 64 well-mixed bits for (seed, purpose, id); each input passes a full mixer before the next is added.
GROUSER_HD constexpr std::uint64_t hash(std::uint64_t seed, std::uint64_t purpose, std::uint64_t id) {
  std::uint64_t h = detail::mix(seed + detail::kGolden);
  h = detail::mix((h ^ purpose) + detail::kGolden);
  return detail::mix((h ^ id) + detail::kGolden);
}

/// The k-th uniform number of (seed, purpose, id), in [0, 1), a multiple of 2^-53.
GROUSER_HD constexpr double uniform(std::uint64_t seed, std::uint64_t purpose, std::uint64_t id, std::uint64_t k = 0) {
  const std::uint64_t bits = detail::mix(hash(seed, purpose, id) + (k + 1) * detail::kGolden);
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

} // namespace grouser::base
