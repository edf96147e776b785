// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace grouser::multibody {

/// A number over time, the sum of
///   polynomial    c[0] + c[1] t + c[2] t^2 + ...
///   harmonics     amplitude sin(frequency t + phase)
///   table         cubic spline through (times, values) that begins and ends at rest; before the first and after the
///                 last time the value stays: the rate never jumps. It may overshoot between unequal steps.
///   ramps         straight lines through (times, values), constant outside: for speeds and forces
/// What is left empty counts 0. Evaluated by base/math.hpp: the same bits on any machine.
struct TimeLaw {
  struct Harmonic {
    double amplitude = 0; ///< unit of the value
    double frequency = 0; ///< [rad/s]
    double phase = 0;     ///< [rad]
  };
  struct Table {
    std::vector<double> times;  ///< [s], increasing
    std::vector<double> values; ///< as many
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

/// Throws base::InputError naming `what` if a number is not finite, a table's times do not increase, or a table has
/// fewer than two points or not as many values as times.
void checkTimeLaw(const char* what, const TimeLaw& law);

} // namespace grouser::multibody
