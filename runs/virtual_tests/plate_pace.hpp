// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

/// How fast a plate may go into a bed.
namespace grouser::virtual_tests {

/// A plate that moves at v sends waves into the bed, which adds density c v to the pressure, c = sqrt(modulus /
/// density) being their speed: a firm bed bears what is asked at sinkages that are passed before the waves have come
/// back from its floor. So the firmer a bed shows itself, the slower its plate goes.
struct PlatePace {
  double density = 0;      ///< of the bed in bulk [kg/m3]
  double breadth = 0;      ///< of the plate [m]
  double depth = 0;        ///< of the bed [m]
  double added = 0;        ///< pressure that waves may add [Pa]
  double fastest = 0;      ///< at any modulus [m/s]
  double firstModulus = 0; ///< of the bed, before it has shown one [Pa]

  double first() const { return speedAt(firstModulus); } ///< [m/s]
  double speedAt(double modulus) const;                  ///< [m/s] at which waves add that pressure
  double wavesBack(double modulus) const;                ///< time that they take to the floor and back [s]
  /// Speed to go on with [m/s]: a half more than `now` at most, and `now` where it is about right.
  double next(double now, double modulus) const;
};

/// What a bed shows of its modulus [Pa] under a plate on its way from where `sinkage` [m] begins: breadth times the
/// slope of the pressure [Pa] over all of it, or over the last `last` rows (2 or more) where that is more. Sinkage
/// falls where the plate goes up. Nought for less than two rows.
double shownModulus(std::span<const double> sinkage, std::span<const double> pressure, double breadth,
                    std::size_t last);

} // namespace grouser::virtual_tests
