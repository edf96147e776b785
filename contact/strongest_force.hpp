// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"

#include <cmath>

namespace grouser::contact {

/// Force [N] of a linear contact pressed to the middle of a grain, or of a Hertz contact to the overlap d where
/// (d / radius)^1.5 = `hertz`: the scale by which sums of forces and energies choose their quanta, on which the last
/// bits of those sums depend.
inline double strongestForce(const ContactLaw& law, double radius, double hertz) {
  return law.stiffness * radius * (law.hertz ? hertz * radius : 1.0);
}
/// The law with its squareScale for grains of `radius` [m].
inline ContactLaw scaledFor(ContactLaw law, double radius) {
  int exponent = 0;
  std::frexp(strongestForce(law, radius, 0.1), &exponent);
  law.squareScale = std::ldexp(1.0, -exponent);
  return law;
}
/// `hertz` of forces, a fifth of the radius, and of energies, a hundredth.
inline constexpr double kForcePress = 0.1, kEnergyPress = 1e-3;

/// Lever arm that sets the quantum of torques [m]: 1 m for grains of 1 mm and more; it falls with the square of smaller
/// radii, so that their rolling resistance still spans many quanta.
inline double leverScale(double radius) {
  const double share = 1e3 * radius;
  return share < 1 ? share * share : 1;
}

} // namespace grouser::contact
