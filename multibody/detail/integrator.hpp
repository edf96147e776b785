// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"
#include "multibody/solver.hpp"

#include <vector>

namespace grouser::multibody::detail {

/// A gap this wide after all iterations means that the step is too long for the motion [m, rad].
inline constexpr double kGapFailure = 1e-6;

/// What the integrators share: the model, its linearised system, and where drives began.
struct Problem {
  const Model& model;
  const SolverOptions& options; ///< defaults resolved
  ConstraintSystem& system;
  const std::vector<double>& driveStart; ///< position of each drive's axis at t = 0 [rad, m]
  StepReport& last;
};

/// A time integration scheme.
class Stepper {
public:
  virtual ~Stepper() = default;
  virtual void step(State& state, const Loads& loads, double dt) = 0;
};

} // namespace grouser::multibody::detail
