// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/soil_limits.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grouser::events {

namespace {

/// Contact area of both tracks [m2].
double groundArea(const VehicleShape& s) { return 2 * s.groundRun() * s.padWidth; }

} // namespace

double holdingSlope(const VehicleShape& shape, const scm::SoilConstants& soil) {
  // sin a - tan phi cos a = c A / W; the left side equals sin(a - phi) / cos(phi).
  const double phi = std::atan(soil.friction);
  const double cohesive = soil.cohesion * groundArea(shape) / shape.weight();
  const double angle = phi + std::asin(std::min(1.0, cohesive * std::cos(phi)));
  return angle < base::kPi / 2 ? std::tan(angle) : std::numeric_limits<double>::infinity();
}

double trackThrust(const VehicleShape& shape, const scm::SoilConstants& soil, double slip) {
  const double most = soil.cohesion * groundArea(shape) + shape.weight() * soil.friction;
  const double x = slip * shape.groundRun() / soil.shearDisplacement;
  return most * (1 + std::expm1(-x) / x);
}

double compactionResistance(const VehicleShape& shape, const scm::SoilConstants& soil) {
  const double pressure = shape.weight() / groundArea(shape), b = shape.padWidth;
  return 2 * b * pressure * soil.sinkageUnder(pressure, b) / (soil.exponent + 1);
}

} // namespace grouser::events
