// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace grouser::base {

/// 64-bit hash of a sequence of words, for comparisons of states; not cryptographic. Each word passes a full 64-bit mix
/// (the finaliser of splitmix64; Steele, Lea and Flood 2014).
class StateHash {
public:
  explicit StateHash(std::uint64_t value = 0) : value_(value) {} ///< continues from another hash's value()

  void add(std::uint64_t word) {
    std::uint64_t z = (value_ ^ word) + 0x9E3779B97F4A7C15ull;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    value_ = z ^ (z >> 31);
  }
  void add(const std::vector<std::uint32_t>& words) {
    add(static_cast<std::uint64_t>(words.size()));
    for (const std::uint32_t w : words) add(static_cast<std::uint64_t>(w));
  }
  std::uint64_t value() const { return value_; }
  /// Returns 16 hexadecimal digits.
  std::string hex() const {
    constexpr char kDigits[] = "0123456789abcdef";
    std::string text(16, '0');
    for (int i = 0; i < 16; ++i) text[static_cast<std::size_t>(15 - i)] = kDigits[value_ >> (4 * i) & 15];
    return text;
  }

private:
  std::uint64_t value_;
};

} // namespace grouser::base
