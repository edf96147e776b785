// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/model.hpp"
#include "multibody/state.hpp"

#include <memory>
#include <string>

namespace grouser::multibody {

struct SolverOptions {
  /// On every hard constraint after a step [m, rad]. What is left of a gap comes back in the next step's constraint
  /// force as up to mass x gap / dt^2: 0.3 N for a shoe of 8.5 kg at 50 us.
  double positionTolerance = 1e-10;
  int maxIterations = 12; ///< of the position solve; typically one or two are used
};

/// How well the last step was solved.
struct StepReport {
  int iterations = 0;
  double maxPositionError = 0; ///< max |C| over the hard rows at the new poses [m, rad]
  int singularRows = 0;        ///< rows without a pivot in this step: a singular position is being passed
};

/// Advances a mechanism by constrained symplectic Euler; solver.cpp states the scheme. Deterministic, one thread,
/// no allocation in step(). A start velocity belongs to the start pose, half a step before the first mean velocity: the
/// first step gets a whole step of load where half would do (a shift in time of dt / 2, the scheme's only first-order
/// error for smooth motions), and needs half the centripetal constraint force.
class Solver {
public:
  /// Orders the elimination and finds redundant constraints. The model must outlive the solver and not change.
  /// Throws base::InputError if joints are not closed at the start (naming the joint and its gap).
  explicit Solver(const Model& model, const SolverOptions& options = {});
  ~Solver();
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;

  /// One step of size dt [s], > 0. Throws base::SimulationError (naming step time and joint or body) when the position
  /// solve fails or a state is not finite.
  void step(State& state, const Loads& loads, double dt);

  const StepReport& lastStep() const;
  /// max |J v| over the hard rows at a state's poses [m/s, rad/s]. The twist is the mean over the step that led there
  /// and meets the constraints over that step to positionTolerance / dt; at its end it leaves them by O(dt |w|^2 size).
  double velocityError(const State& state) const;
  /// Size of the problem, independent parts, fill of the factor, and what was done about redundant rows.
  const std::string& report() const;
  /// Rows dropped because others imply them.
  int redundantRows() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace grouser::multibody
