// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace grouser::coupling {

/// Bound on the growth of transverse oscillations of tensioned joints while the tension exceeds the limit of the step.
/// At r times the longest stable step an oscillation grows (r + sqrt(r^2 - 1))^2 times a step. The smaller growth of
/// this check and the last counts, so that a peak between them, or at one of them, does not.
class SwingGrowth {
public:
  /// Constraint errors of joints, 1e-10 m at most, grow to 0.1 mm by this factor [-].
  static constexpr double kMost = 1e6;

  /// A check, `steps` after the last one; r: the step over the longest stable one. False if the growth is too large.
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
  double rate_ = 1, grown_ = 1; ///< per step at the last check, and since it first exceeded 1
};

} // namespace grouser::coupling
