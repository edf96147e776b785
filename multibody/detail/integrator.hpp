// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"
#include "multibody/solver_options.hpp"
#include "multibody/state.hpp"

#include <vector>

namespace grouser::multibody::detail {

/// If the gap after all iterations exceeds this value, the step is too long for the motion [m, rad].
inline constexpr double kGapFailure = 1e-6;

/// Maximum rotation of a body per step [rad]; beyond half a turn, its path and joint angles are ambiguous.
inline constexpr double kLargestTurn = 3;

/// Throws base::SimulationError if a twist is not finite or rotates the body too far in a step starting at `time`.
void checkTwist(const Body& body, const Twist& twist, double time, double dt);

/// Shared data of the integrators: the model, its linearised system, and the initial positions of drives.
struct Problem {
  const Model& model;
  const SolverOptions& options; ///< with defaults resolved
  ConstraintSystem& system;
  const std::vector<double>& driveStart; ///< position of each drive's axis at t = 0 [rad, m]
  StepReport& last;
};

/// Interface of a time integration scheme.
class Stepper {
public:
  virtual ~Stepper() = default;
  virtual void step(State& state, const Loads& loads, double dt) = 0;
  /// See Solver::startResponse(). The default throws std::logic_error.
  virtual void startResponse(const State& state, const Loads& loads, double dt, std::vector<Twist>& twists);
  virtual void respond(const std::vector<Wrench>& impulses, std::vector<Twist>& change);
};

} // namespace grouser::multibody::detail
