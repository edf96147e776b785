// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace grouser::coupling {

/// Bound on the growth of transverse oscillations of tensioned joints while the tension exceeds the limit of the step.
/// At r times the longest stable step an oscillation grows by (r + sqrt(r^2 - 1))^2 per step. The smaller growth of
/// this check and the last one applies, so that single peaks have no effect.
class SwingGrowth {
public:
  /// Maximum growth factor [-]: constraint errors of joints, at most 1e-10 m, grow to 0.1 mm.
  static constexpr double kMax = 1e6;

  /// Records a check, `steps` after the last one; r: step / longest stable step. Returns false if growth exceeds kMax.
  bool bears(double r, std::int64_t steps) {
    if (!(r > 1)) {
      rate_ = grown_ = 1;
      return true;
    }
    const double now = (r + std::sqrt(r * r - 1)) * (r + std::sqrt(r * r - 1)), rate = std::min(now, rate_);
    rate_ = now;
    for (std::int64_t i = 0; i < steps && grown_ < kMax; ++i) grown_ *= rate;
    return grown_ < kMax;
  }

  std::vector<double> save() const { return {rate_, grown_}; }
  void restore(double rate, double grown) { rate_ = rate, grown_ = grown; }

private:
  double rate_ = 1, grown_ = 1; ///< growth per step at the last check; total growth since it first exceeded 1
};

} // namespace grouser::coupling
