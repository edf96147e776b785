// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace grouser::vehicle {

/// Detects ground impacts on a vehicle by the ratio of upward ground force to weight, averaged over at least kSpan. If
/// a vehicle lands on rigid arms, or on arms at their stops, this ratio is far above 1. The first shoe in contact then
/// determines the motion, so that it depends on time step and seed (docs/evidence/vehicle_stability.md).
class BlowMeter {
public:
  static constexpr double kSpan = 0.01; ///< [s]
  static constexpr double kBlow = 4;    ///< force over weight above which a run reports an impact [-]

  BlowMeter() = default;
  explicit BlowMeter(double weight) : weight_(weight) {} ///< [N]; 0: impacts are not reported

  void setWeight(double weight) { weight_ = weight; } ///< [N]
  /// `up`: mean upward ground force since the last call [N]; NaN if unknown.
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
  std::string text() const; ///< report of the largest impact

  static constexpr std::size_t kNumbers = 5;
  std::vector<double> save() const { return {most, at, last_, impulse_, span_}; }
  /// `saved`: the kNumbers values of save().
  void restore(const std::vector<double>& saved) {
    most = saved[0], at = saved[1], last_ = saved[2], impulse_ = saved[3], span_ = saved[4];
  }

  double most = 0; ///< largest mean so far, in vehicle weights [-]
  double at = 0;   ///< end time of the interval of the largest mean [s]

private:
  double weight_ = 0, last_ = 0, impulse_ = 0, span_ = 0;
};

} // namespace grouser::vehicle
