// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/bearing.hpp"

#include "base/math.hpp"

#include <cmath>

namespace grouser::virtual_tests {

BearingFactors bearingFactors(double angle) {
  const double t = std::tan(angle), half = std::tan(0.25 * base::kPi + 0.5 * angle);
  BearingFactors f;
  f.nq = std::exp(base::kPi * t) * half * half;
  f.nc = t > 1e-9 ? (f.nq - 1) / t : base::kPi + 2;
  f.ngamma = 2 * (f.nq + 1) * t;
  return f;
}

double bearingPressure(PlateShape shape, double angle, double unitWeight, double breadth, double depth) {
  const BearingFactors f = bearingFactors(angle);
  const bool round = shape == PlateShape::circular;
  const double sq = round ? 1 + std::tan(angle) : 1, sgamma = round ? 0.6 : 1;
  return unitWeight * (depth * f.nq * sq + 0.5 * breadth * f.ngamma * sgamma);
}

double bearingAngle(PlateShape shape, double pressure, double unitWeight, double breadth, double depth) {
  double low = 0, high = base::kPi / 3;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (bearingPressure(shape, middle, unitWeight, breadth, depth) < pressure ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

} // namespace grouser::virtual_tests
