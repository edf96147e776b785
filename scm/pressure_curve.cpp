// SPDX-License-Identifier: BSD-3-Clause
#include "scm/pressure_curve.hpp"

#include "base/math.hpp"

namespace grouser::scm {

PressureCurve::PressureCurve(double exponent, double deepest) : deepest_(deepest) {
  const auto place = [&](int i) { return deepest * (static_cast<double>(i) / kIntervals) * i / kIntervals; };
  const auto value = [&](int i) { return i == 0 ? 0 : base::pow(place(i), exponent); };
  double integral = 0;
  for (int i = 0; i < kIntervals; ++i) {
    const double left = place(i), right = place(i + 1), low = value(i), high = value(i + 1);
    knots_.push_back({left, low, (high - low) / (right - left), integral});
    integral += 0.5 * (low + high) * (right - left);
  }
}

} // namespace grouser::scm
