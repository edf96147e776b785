// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace grouser::multibody {

/// Function of time: the sum of
///   polynomial    c[0] + c[1] t + c[2] t^2 + ...
///   harmonics     amplitude sin(frequency t + phase)
///   table         cubic spline through (times, values) with zero rate at both ends; constant before the first and
///                 after the last time, so that the rate never jumps. May overshoot with unequal intervals.
///   ramps         piecewise linear through (times, values), constant outside; for speeds and forces. A repeated time
///                 is a jump; at this time the first of the two values applies.
/// Empty terms are 0. base/math.hpp evaluates all functions; results are bitwise identical on all machines.
struct TimeLaw {
  struct Harmonic {
    double amplitude = 0; ///< unit of the value
    double frequency = 0; ///< [rad/s]
    double phase = 0;     ///< [rad]
  };
  struct Table {
    std::vector<double> times;  ///< [s], increasing; a repeated time is a jump (ramps only)
    std::vector<double> values; ///< same number as times
  };

  std::vector<double> polynomial{}; ///< unit of the value over s^i
  std::vector<Harmonic> harmonics{};
  Table table{};
  Table ramps{};

  bool empty() const;
  double value(double t) const;
  double rate(double t) const;         ///< first derivative
  double acceleration(double t) const; ///< second derivative
  double integral(double t) const;     ///< from 0 to t

  static TimeLaw constant(double value) { return {{value}, {}, {}, {}}; }
};

/// Index of the first time of a table that does not increase, 0 if there is none. With `jumps`, a time may occur twice
/// and then marks a jump of the value.
inline std::size_t firstOutOfOrder(const std::vector<double>& times, bool jumps) {
  for (std::size_t i = 1; i < times.size(); ++i) {
    const bool jump = jumps && times[i] == times[i - 1] && !(i > 1 && times[i - 1] == times[i - 2]);
    if (!(times[i] > times[i - 1]) && !jump) return i;
  }
  return 0;
}

/// Returns the error in a law, or an empty string: a number is not finite, times do not increase, or a table has fewer
/// than two points or unequal numbers of times and values.
std::string timeLawFault(const TimeLaw& law);

} // namespace grouser::multibody
