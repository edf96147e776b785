// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"
#include "multibody/state.hpp"

#include <vector>

namespace grouser::multibody::detail {

/// Work done over one step through a soft or driven row [J].
struct AxisWork {
  double drive = 0, spring = 0, dissipated = 0;
  double joint = 0, springs = 0, stops = 0; ///< dissipated by the dampers of joints, springs and stops
};

/// Assembles the forces along each axis row in one step of the symplectic Euler scheme: joint damping, springs, end
/// stops, drives. Springs are implicit,
///   F = F_0 - k (x + dt x'_new - x_0) - c x'_new  =  [F_0 - k (x - x_0)]  -  (c + dt k) x'_new,
/// where the bracket is known at the start of the step; the last term is a soft row of compliance 1 / (dt c + dt^2 k).
class AxisLaws {
public:
  AxisLaws(const Model& model, const ConstraintSystem& system);

  /// `laws`: one per axis. `start`: positions of the driven axes at the start of their laws, one per drive.
  void evaluate(const ConstraintSystem& system, const State& state, const Loads& loads, double dt,
                const std::vector<Frame>& frames, const std::vector<double>& start, std::vector<AxisLaw>& laws) const;

  /// Work of one row. `multiplier`: impulse of the row / dt; `path`: mean rate times dt.
  AxisWork work(const AxisLaw& law, double multiplier, double newRate, double path, double dt) const;

private:
  const Model* model_;
  std::vector<double> jointDamping_; ///< damping of the joint axes, which precede all other axes
};

/// Signed distance beyond the limits of a spring's end stops; 0 between them.
double overLimit(const AxisSpring& spring, double position);

/// Position and rate of an axis in a state.
double& axisPositionIn(State& state, const ConstraintSystem& system, int axis);
double axisPositionIn(const State& state, const ConstraintSystem& system, int axis);
double axisRateIn(const State& state, const ConstraintSystem& system, int axis);

/// Position of each drive's axis at the model's poses.
std::vector<double> driveStart(const ConstraintSystem& system, const Model& model);

/// True if the drive imposes the motion of its axis by a constraint.
inline bool imposesMotion(const Drive& drive) { return drive.kind != DriveKind::kForce; }

/// Position imposed by a drive's law at time t [rad, m]; `start`: axis position at t = 0.
double drivenPosition(const Drive& drive, double start, double t);
/// Rate imposed by a drive's law at time t [rad/s, m/s].
double drivenRate(const Drive& drive, double t);

} // namespace grouser::multibody::detail
