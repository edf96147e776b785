// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cmath>
#include <vector>

namespace grouser::scm {

/// z^n tabulated as a piecewise linear function g(z) with its exact integral, so that steps need no powers and energies
/// match pressures to rounding. Knots are at deepest (i / kIntervals)^2, so the relative error n (n - 1) / (2 i^2)
/// decreases with depth: 1e-4 beyond a thousandth of the depth at n = 0.8. The last segment is extrapolated beyond the
/// deepest knot.
class PressureCurve {
public:
  static constexpr int kIntervals = 1024;

  /// `exponent`: n > 0; `deepest` [m] > 0.
  PressureCurve(double exponent, double deepest);

  /// g(z) [m^n], and its integral from 0 [m^(n+1)]; z >= 0 [m].
  double at(double z) const {
    const Knot& k = knots_[interval(z)];
    return k.value + k.slope * (z - k.place);
  }
  double integralTo(double z) const {
    const Knot& k = knots_[interval(z)];
    const double beyond = z - k.place;
    return k.integral + beyond * (k.value + 0.5 * k.slope * beyond);
  }
  /// Slope of g to the right of z [m^(n-1)].
  double slopeAt(double z) const { return knots_[interval(z)].slope; }

private:
  struct Knot {
    double place, value, slope, integral;
  };
  std::size_t interval(double z) const {
    const double i = kIntervals * std::sqrt(z / deepest_);
    return i < kIntervals - 1 ? static_cast<std::size_t>(i) : kIntervals - 1;
  }

  double deepest_;
  std::vector<Knot> knots_; ///< one per interval, at its left end
};

} // namespace grouser::scm
