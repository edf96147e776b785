// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace grouser::coupling {

/// By how much swings across a pull in joints may have grown while it was above what the step bears. At r times the
/// longest stable step a swing grows (r + sqrt(r^2 - 1))^2 times a step. What counts is the lesser growth of this look
/// and the last, so that a peak between them, or at one of them, counts nothing.
class SwingGrowth {
public:
  /// What joints' closure leaves open, 1e-10 m at most, is 0.1 mm when it has grown so much [-].
  static constexpr double kMost = 1e6;

  /// A look, `steps` after the last one; r: the step over the longest stable one. False where it has grown too much.
  bool bears(double r, std::int64_t steps) {
    if (!(r > 1)) {
      rate_ = grown_ = 1;
      return true;
    }
    const double now = (r + std::sqrt(r * r - 1)) * (r + std::sqrt(r * r - 1)), rate = std::min(now, rate_);
    rate_ = now;
    for (std::int64_t i = 0; i < steps && grown_ < kMost; ++i) grown_ *= rate;
    return grown_ < kMost;
  }

  std::vector<double> save() const { return {rate_, grown_}; }
  void restore(double rate, double grown) { rate_ = rate, grown_ = grown; }

private:
  double rate_ = 1, grown_ = 1; ///< a step at the last look, and since it first was above
};

} // namespace grouser::coupling
