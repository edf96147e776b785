// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"
#include "multibody/state.hpp"

#include <vector>

namespace grouser::multibody::detail {

/// Force law along one axis row over one stage of RATTLE, from position x0 to x1 in the time h.
struct SoftRow {
  double constant = 0;                        ///< springs: F = constant - stiffness x
  double stiffness = 0;                       ///< [N/m] or [N m/rad]
  double damping = 0;                         ///< sum over the dampers of joint and springs
  double jointDamping = 0, springDamping = 0; ///< contributions to `damping`
  double applied0 = 0;                        ///< force drives at the beginning and at the end of the stage
  double applied1 = 0;
  bool stops = false;  ///< has end stops
  bool driven = false; ///< position and rate are imposed
  double target = 0;   ///< imposed position at the end of the stage with a law, or its increment without (`relative`)
  bool relative = false;
  double rate = 0;         ///< at the end of the stage
  double acceleration = 0; ///< at the end of the stage
};

/// Force and its derivative.
struct ForceAndSlope {
  double force = 0;
  double slope = 0; ///< -dF/dx1, >= 0 for h > 0
};

/// Collects the laws of all axis rows for a stage.
class SoftRows {
public:
  SoftRows(const Model& model, const ConstraintSystem& system, const std::vector<double>& driveStart);

  /// Evaluates the laws over the stage from time t to t + h.
  void evaluate(const Loads& loads, double t, double h, std::vector<SoftRow>& rows) const;

  /// End stops as discrete gradients of their energies V = stopStiffness over^2 / 2, with `over` beyond the limit:
  ///   F = -(V(x1) - V(x0)) / (x1 - x0) - stopDamping (over1 - over0) / h,   0 where F would be adhesive,
  /// so that the work of the elastic part in a stage of any length is exactly -(V(x1) - V(x0)).
  ForceAndSlope stops(int axis, double x0, double x1, double h) const;
  /// Force of the stops at a position and rate.
  double stopForce(int axis, double x, double rate) const;
  /// Force of springs and stops, without the springs' dampers, at a position and rate.
  double springForce(const SoftRow& row, int axis, double x, double rate) const {
    return row.constant - row.stiffness * x + (row.stops ? stopForce(axis, x, rate) : 0);
  }
  /// Energy of springs (with preloads as constant forces) and stops at a position [J].
  double energy(const SoftRow& row, int axis, double x) const;
  /// Energy dissipated by the dampers of the stops over a stage [J].
  double stopLoss(int axis, double x0, double x1, double h) const;

private:
  const Model& model_;
  const ConstraintSystem& system_;
  const std::vector<double>& driveStart_;
  std::vector<std::vector<int>> stopsOf_; ///< axis springs with limits, one list per axis
};

} // namespace grouser::multibody::detail
