// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"

#include <cmath>

namespace grouser::contact {

/// Force [N] of a linear contact at an overlap of one grain radius, or of a Hertz contact at the overlap d with (d /
/// radius)^1.5 = `hertz`. Sets the scale of the quanta of force and energy sums, and so affects the last bits of these
/// sums.
inline double strongestForce(const ContactLaw& law, double radius, double hertz) {
  return law.stiffness * radius * (law.hertz ? hertz * radius : 1.0);
}
/// Returns the law with squareScale set for grains of `radius` [m].
inline ContactLaw scaledFor(ContactLaw law, double radius) {
  int exponent = 0;
  std::frexp(strongestForce(law, radius, 0.1), &exponent);
  law.squareScale = std::ldexp(1.0, -exponent);
  return law;
}
/// `hertz` for forces (overlap of a fifth of the radius) and for energies (a hundredth).
inline constexpr double kForcePress = 0.1, kEnergyPress = 1e-3;

/// Lever arm that sets the quantum of torques [m]: 1 m for grains of 1 mm and more; proportional to radius^2 below, so
/// that rolling resistance still spans many quanta.
inline double leverScale(double radius) {
  const double share = 1e3 * radius;
  return share < 1 ? share * share : 1;
}

} // namespace grouser::contact
