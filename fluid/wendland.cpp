// SPDX-License-Identifier: BSD-3-Clause
#include "fluid/wendland.hpp"

#include "base/math.hpp"

namespace grouser::fluid {

Wendland::Wendland(double length, int dimensions) : length_(length) {
  norm_ = dimensions == 2 ? 7 / (4 * base::kPi * length * length) : 21 / (16 * base::kPi * length * length * length);
}

double Wendland::value(double r) const {
  const double q = r / length_, t = 1 - q / 2;
  return q < 2 ? norm_ * t * t * t * t * (1 + 2 * q) : 0;
}

double Wendland::slope(double r) const {
  const double q = r / length_, t = 1 - q / 2;
  return q < 2 ? slopeAtCentre() * t * t * t : 0;
}

double Wendland::slopeAtCentre() const { return -5 * norm_ / (length_ * length_); }

double Wendland::steepest() const { return -slope(length_ / 2) * length_ / 2; }

} // namespace grouser::fluid
