// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/model.hpp"
#include "multibody/state.hpp"

namespace grouser::multibody {

/// Position, rate [rad, rad/s or m, m/s] and force [N m or N] of a joint's axis; kOnly where there is one axis.
AxisReading axisReading(const Model& model, const State& state, int joint, JointAxis axis = JointAxis::kOnly);
/// Force a drive exerted on B along its axis in the last step [N m] or [N], and its power [W], positive when it puts
/// energy into the mechanism.
double driveForce(const Model& model, const State& state, int drive);
double drivePower(const Model& model, const State& state, int drive);

/// Energies [J] and momenta of a state.
struct Totals {
  double kinetic = 0;
  double gravity = 0; ///< -sum m g.p
  double elastic = 0; ///< springs, preloads (as constant forces from freePosition or restLength on) and stops
  Vec3d linearMomentum;
  Vec3d angularMomentum; ///< about the world's origin
};
Totals totals(const Model& model, const State& state, const Loads& loads);

} // namespace grouser::multibody
