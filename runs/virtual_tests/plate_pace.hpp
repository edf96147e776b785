// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

/// Speed of a plate pushed into a bed.
namespace grouser::virtual_tests {

/// A plate at speed v emits waves that add density c v to the pressure; their speed is c = sqrt(modulus / density).
/// On a stiff bed the plate reaches the target pressure before the waves return from the floor. Therefore the plate
/// moves more slowly on stiffer beds.
struct PlatePace {
  double density = 0;      ///< bulk density of the bed [kg/m3]
  double breadth = 0;      ///< plate breadth [m]
  double depth = 0;        ///< bed depth [m]
  double added = 0;        ///< pressure that waves may add [Pa]
  double fastest = 0;      ///< maximum speed [m/s]
  double firstModulus = 0; ///< initial estimate of the modulus [Pa]

  double first() const { return speedAt(firstModulus); } ///< [m/s]
  double speedAt(double modulus) const;                  ///< speed at which waves add `added` to the pressure [m/s]
  double wavesBack(double modulus) const;                ///< travel time of waves to the floor and back [s]
  /// Next speed [m/s]: speedAt(modulus), but at most 1.5 times `now`; unchanged if the result is within 20 % of `now`.
  double next(double now, double modulus) const;
};

/// Apparent modulus of a bed [Pa]: plate breadth times the slope of `pressure` [Pa] over `sinkage` [m], either of all
/// rows or of the last `last` rows (2 or more), whichever is larger. Sinkage may decrease. 0 for fewer than two rows.
double apparentModulus(std::span<const double> sinkage, std::span<const double> pressure, double breadth,
                       std::size_t last);

} // namespace grouser::virtual_tests
