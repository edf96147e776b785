// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/model.hpp"
#include "multibody/state.hpp"

namespace grouser::multibody {

/// Returns position, rate [rad, rad/s or m, m/s] and force [N m or N] of a joint axis; kOnly for single-axis joints.
AxisReading axisReading(const Model& model, const State& state, int joint, JointAxis axis = JointAxis::kOnly);
/// Force [N] or torque [N m] exerted by a drive on B along its axis in the last step, and power of the drive [W],
/// positive if the drive adds energy to the mechanism.
double driveForce(const Model& model, const State& state, int drive);
double drivePower(const Model& model, const State& state, int drive);

/// Energies [J] and momenta of a state.
struct Totals {
  double kinetic = 0;
  double gravity = 0; ///< -sum m g.p
  double elastic = 0; ///< springs, preloads (as constant forces relative to freePosition or restLength) and stops
  Vec3d linearMomentum;
  Vec3d angularMomentum; ///< about the world origin
};
Totals totals(const Model& model, const State& state, const Loads& loads);
/// Elastic energy only [J].
double elasticEnergy(const Model& model, const State& state, const Loads& loads);

/// Balance of the ledger of a state (ledger.hpp) since its first step [J, N s, N m s]:
///   kineticGain + potentialGain + elasticGain + dissipated() + integrationError = driveWork + externalWork + leftOver
/// Energy added by changing loads (ramps of springs and of gravity) counts neither as stored energy nor as work, since
/// the gains in each step are computed with constant loads.
struct Balance {
  Totals now; ///< totals of the current state
  double driveWork = 0, externalWork = 0;
  double kineticGain = 0, potentialGain = 0, elasticGain = 0;
  double jointDamping = 0;  ///< dissipated by joint dampers
  double springDamping = 0; ///< dissipated by axis springs, point springs and bushings
  double stopDamping = 0;   ///< dissipated by end stops
  double dissipated() const { return jointDamping + springDamping + stopDamping; }
  double integrationError = 0; ///< error of the finite step; tends to 0 with it
  double leftOver = 0;         ///< residual of the kinetic energy: rounding
  double turnover = 0;         ///< sum of absolute works plus initial kinetic energy
  Vec3d linearRemainder;       ///< momentum residual: rounding
  Vec3d angularRemainder;      ///< angular momentum residual about the world origin
};
Balance balance(const Model& model, const State& state, const Loads& loads);
/// Initialises the ledger of a state; the solver calls it before its first step.
void beginLedger(const Model& model, State& state, const Loads& loads);

} // namespace grouser::multibody
