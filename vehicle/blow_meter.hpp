// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace grouser::vehicle {

/// How hard the ground strikes a vehicle: its force upward over the weight, in means over at least kSpan. Where a
/// vehicle comes down on stopped or rigid arms, it is struck with many times its weight, and which shoe meets the
/// ground first then decides what follows: the step and chance have a say in it (docs/evidence/vehicle_stability.md).
class BlowMeter {
public:
  static constexpr double kSpan = 0.01; ///< [s]
  static constexpr double kBlow = 4;    ///< weights, from which on a run says so [-]

  BlowMeter() = default;
  explicit BlowMeter(double weight) : weight_(weight) {} ///< [N]; 0: nothing is a blow

  void setWeight(double weight) { weight_ = weight; } ///< [N]
  /// `up`: mean force of the ground since the last call [N]; NaN where it is not known.
  void add(double time, double up) {
    const double span = time - last_;
    last_ = time;
    if (!std::isfinite(up) || !(weight_ > 0)) return;
    impulse_ += up * span, span_ += span;
    if (span_ < kSpan * (1 - 1e-6)) return;
    if (const double mean = impulse_ / span_ / weight_; mean > most) most = mean, at = time;
    impulse_ = span_ = 0;
  }
  bool isBlow() const { return most > kBlow; }
  std::string text() const; ///< what a run says of a blow

  static constexpr std::size_t kNumbers = 5;
  std::vector<double> save() const { return {most, at, last_, impulse_, span_}; }
  /// `saved`: kNumbers, of save().
  void restore(const std::vector<double>& saved) {
    most = saved[0], at = saved[1], last_ = saved[2], impulse_ = saved[3], span_ = saved[4];
  }

  double most = 0; ///< greatest so far, in weights [-]
  double at = 0;   ///< end of that mean [s]

private:
  double weight_ = 0, last_ = 0, impulse_ = 0, span_ = 0;
};

} // namespace grouser::vehicle
