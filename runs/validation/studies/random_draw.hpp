// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "base/random.hpp"

#include <algorithm>
#include <cstdint>

namespace grouser::studies {

/// Sequence of random numbers for one scene. It is determined by seed, purpose and number of the scene.
class Draw {
public:
  Draw(std::uint64_t seed, std::uint64_t purpose, int number)
      : seed_(seed), purpose_(purpose), number_(static_cast<std::uint64_t>(number)) {}
  /// Uniform random number.
  double in(double low, double high) { return low + (high - low) * base::uniform(seed_, purpose_, number_, k_++); }
  /// Random number with a uniform logarithm.
  double over(double low, double high) { return low * base::exp(in(0, 1) * base::log(high / low)); }
  /// True with this probability.
  bool once(double share) { return in(0, 1) < share; }
  /// Random integer in [low, high].
  int of(int low, int high) { return std::min(high, low + static_cast<int>(in(0, 1) * (high - low + 1))); }

private:
  std::uint64_t seed_, purpose_, number_, k_ = 0;
};

} // namespace grouser::studies
