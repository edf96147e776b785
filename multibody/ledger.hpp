// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

namespace grouser::multibody {

/// Compensated sum: a sum of a million small terms is as accurate as a single addition. The rounding error of each
/// addition is computed exactly (Knuth 1997, The Art of Computer Programming 2, 4.2.2, theorem B) and summed separately
/// (Neumaier 1974, ZAMM 54:39). The member `sum` is the uncompensated sum.
struct CompensatedSum {
  double sum = 0, lost = 0;

  CompensatedSum& operator+=(double x) {
    const double next = sum + x, added = next - sum;
    lost += (sum - (next - added)) + (x - added);
    sum = next;
    return *this;
  }
  double value() const { return sum + lost; }
  operator double() const { return value(); } // NOLINT(google-explicit-constructor): it is a number
};

struct CompensatedVector {
  CompensatedSum x, y, z;

  CompensatedVector& operator+=(const base::Vec3d& v) {
    x += v.x, y += v.y, z += v.z;
    return *this;
  }
  base::Vec3d value() const { return {x, y, z}; }
};

/// Energy and momentum ledger of a mechanism since its first step [J, N s, N m s].
///
/// An impulse p changes the kinetic energy of a body by exactly p . (v_before + v_after) / 2; the same holds for a
/// torque impulse and the angular velocities. kineticWork sums these changes over all impulses of all steps, including
/// constraint and gyroscopic impulses. It must equal the kinetic energy gain of the bodies; any difference is rounding
/// or an unrecorded change of the state. Potential and elastic energy are functions of positions. Therefore
///   integration error = drives + external loads - dissipated - potential - elastic - kineticWork
/// is the error of conservative forces, workless constraints and gyroscopic terms. See balance() in readings.hpp. New
/// kinds of forces must be recorded in detail/euler_ledger.cpp and detail/rattle_ledger.cpp.
struct Ledger {
  /// kSymplecticEuler: impulse times the mean of the rates before and after the step. kRattle: for gravity and springs
  /// the energy decrease, for drives and dampers force times path in each stage, for loads as in kSymplecticEuler.
  CompensatedSum gravityWork, externalWork, driveWork;
  CompensatedSum springWork; ///< work of elastic forces and preloads
  CompensatedSum dissipated; ///< sum of the three damping terms below, rounded differently

  CompensatedSum kineticWork;
  CompensatedSum potentialGain, elasticGain; ///< sums of the gains in each step, at the loads of this step
  CompensatedSum jointDamping, springDamping, stopDamping;
  /// Reference for relative errors: sum of the absolute work of all forces plus the initial kinetic energy. The term of
  /// constraints is the total work of each on both bodies (kSymplecticEuler), or of all on each body (kRattle).
  CompensatedSum turnover;
  /// Impulses of gravity, external loads and immovable bodies, and their moments about the world origin.
  CompensatedVector linearImpulse, angularImpulse;

  /// Reference values, set before the first step.
  double begun = 0; ///< 1 once the reference values are set
  double startKinetic = 0;
  base::Vec3d startLinear, startAngular;

  double integrationError() const;
};

/// Contribution of one step, or one stage, to the ledger.
struct StepLedger {
  double kinetic = 0, turnover = 0;
  base::Vec3d linear, angular; ///< external impulses
  double jointDamping = 0, springDamping = 0, stopDamping = 0;
  double external = 0, potential = 0, elastic = 0;

  void addTo(Ledger& ledger) const;
};

} // namespace grouser::multibody
