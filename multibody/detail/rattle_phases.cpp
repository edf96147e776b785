// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/rattle_step.hpp"

#include "base/error.hpp"
#include "multibody/detail/index.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>

/// Position solve of a stage of RATTLE (scheme: rattle_step.cpp): Newton's method on the residuals of
/// rattle_position.cpp, with further phases if it converges slowly.
namespace grouser::multibody::detail {

namespace {

/// Smallest tolerance of gaps, relative to the coordinates.
constexpr double kRoundOff = 5e-16;

/// In units of the tolerance: the largest stalled gap that counts as round-off (which accumulates over a long loop),
/// and the gap accepted if no phase is left (1e-12 m or rad by default).
constexpr double kNearTolerance = 1e2, kAcceptable = 1e3;

/// Gap ratios of successive iterations. With the matrix of the start of a stage, Newton's method reduces a gap by a
/// factor h |w|, about 1e-2 in a reasonable step. If the ratio exceeds a fifth, the cause is not curvature, and a
/// change of phase costs less than further iterations. If it exceeds a half, the gap is round-off.
constexpr double kSlowIteration = 0.2, kStalled = 0.5;

} // namespace

void RattleStep::solvePositions(const Part& part, const State& state, const Loads& loads, double h) {
  PositionSolve solve;
  solve.tolerance = gapTolerance(part, state);
  startAxes(part, state, h);
  solve.lost = positionsFactored(part) ? 0 : linearise(part, frames_);
  factored_[at(part.index)] = -1;
  relinearised_[at(part.index)] = 0;
  predictSoftRows(part, h);
  setFirstResidual(part, state, loads, h);
  setResiduals(part, h);

  mixing_.reset();
  for (bool solved = false; !solved;) {
    iterate(part, state, h, solve);
    solved = advance(part, state, loads, h, solve);
    if (solved || solve.phase != Phase::kEachIterate) continue;
    const int lostHere = solve.since == 0 ? closeWeakRows(part, state, h) : linearise(part, trial_);
    solve.lost = std::max(solve.lost, lostHere);
  }
  // The gap of all rows, including rows without a pivot.
  if (!(gapOf_[at(part.index)] <= kGapFailure)) fail(part, state, gapOf_[at(part.index)], h);
  last_.maxPositionError = std::max(last_.maxPositionError, gapOf_[at(part.index)]);
  collectMomentum(part, state, loads, h);
}

/// At least a few units in the last place of the coordinates.
double RattleStep::gapTolerance(const Part& part, const State& state) const {
  double scale = 0;
  for (const int node : part.bodies) {
    const Vec3d& p = state.pose[at(system_.bodyOf(node))].position;
    scale = std::max({scale, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  }
  return std::max(options_.positionTolerance, kRoundOff * scale);
}

/// One Newton iteration and its convergence.
void RattleStep::iterate(const Part& part, const State& state, double h, PositionSolve& solve) {
  system_.solve(part, x_);
  if (mixing_.on() && !relinearised_[at(part.index)]) mixing_.improve(part, {mean_, impulse_, couplingImpulse_}, x_);
  applyCorrection(part, h);
  moveTrial(part, state, h);
  solve.follow = updateAxes(part, h);
  solve.gap = setResiduals(part, h);
  solve.open = gapOf_[at(part.index)];
  ++solve.iterations, ++solve.since;
  last_.iterations = std::max(last_.iterations, solve.iterations);

  // A stalled gap slightly above the tolerance is round-off.
  const bool atRoundOff =
      std::min(solve.best, solve.gap) <= kNearTolerance * solve.tolerance && solve.gap > kStalled * solve.before;
  solve.done = !solve.follow && (solve.gap <= solve.tolerance || atRoundOff);
  solve.slow = solve.since > 1 && !(solve.gap <= kSlowIteration * solve.before);
  solve.best = std::min(solve.best, solve.gap);
  solve.before = solve.gap;
}

/// Evaluates an iteration: returns true if converged, or enters the next phase.
bool RattleStep::advance(const Part& part, const State& state, const Loads& loads, double h, PositionSolve& solve) {
  switch (solve.phase) {
  case Phase::kAllRows:
    return advanceAllRows(part, state, loads, h, solve);
  case Phase::kWithoutWeakRows:
    advanceWithoutWeakRows(part, solve);
    return false;
  case Phase::kMixed:
    if (solve.done && solve.open <= kNearTolerance * solve.tolerance) return true;
    if (solve.done || solve.since >= 2 * options_.maxIterations || !std::isfinite(solve.gap))
      solve.enter(Phase::kEachIterate);
    return false;
  case Phase::kEachIterate:
    break;
  }
  if (solve.done) return true;
  if (solve.since < 2 * options_.maxIterations) return false;
  // If rows have lost their pivot, small gaps may remain; they close once the singular position is passed.
  if (!(solve.gap <= (solve.lost > 0 ? kGapFailure : kAcceptable * solve.tolerance))) fail(part, state, solve.gap, h);
  return true;
}

/// Iterates with all rows and the matrix of the start of the stage; sufficient for nearly every step.
bool RattleStep::advanceAllRows(const Part& part, const State& state, const Loads& loads, double h,
                                PositionSolve& solve) {
  const bool closed = solve.lost == 0 || solve.open <= kNearTolerance * solve.tolerance;
  if (solve.done && closed) return true;
  mixing_.remember(part, solve.gap, mean_);
  if ((solve.done || solve.slow) && !mixing_.on() && startWithoutWeakRows(part, state, loads, h)) {
    solve.enter(Phase::kWithoutWeakRows);
  } else if (solve.done) {
    return true;
  } else if (solve.since >= options_.maxIterations) {
    solve.enter(Phase::kEachIterate);
  } else if (solve.follow) {
    solve.lost = std::max(solve.lost, linearise(part, frames_));
    mixing_.forget();
  } else if (solve.slow && !mixing_.on()) {
    mixing_.switchOn();
  }
  return false;
}

/// Iterates without the weak rows to the inertial motion; from this iterate all rows converge quickly, to the solution
/// consistent with inertia.
void RattleStep::advanceWithoutWeakRows(const Part& part, PositionSolve& solve) {
  if (!solve.done && solve.since < options_.maxIterations && !(solve.since > 2 && solve.slow)) return;
  mixing_.reset();
  mixing_.remember(part, solve.gap, mean_);
  system_.scalePivotThreshold(firmPivotScale(options_.positionTolerance));
  linearise(part, frames_);
  system_.scalePivotThreshold(1);
  mixing_.switchOn();
  solve.enter(Phase::kMixed);
}

/// Restarts the solve from the old twist, without rows with pivots that may pass through zero in such a rotation:
/// near a singular position their impulses would diverge. Their gaps are second order in a motion across the singular
/// direction, hence small. Returns false, without changes, if there are no such rows.
bool RattleStep::startWithoutWeakRows(const Part& part, const State& state, const Loads& loads, double h) {
  double turn = 0;
  for (const int node : part.bodies)
    turn = std::max(turn, std::fabs(h) * norm(state.twist[at(system_.bodyOf(node))].w));
  system_.scalePivotThreshold(weakPivotScale(turn));
  const int weak = system_.linearise(part, frames_, laws_);
  system_.scalePivotThreshold(1);
  if (weak == 0) {
    system_.linearise(part, frames_, laws_);
    return false;
  }
  for (const int node : part.bodies) mean_[at(system_.bodyOf(node))] = state.twist[at(system_.bodyOf(node))];
  moveTrial(part, state, h);
  updateAxes(part, h);
  setFirstResidual(part, state, loads, h);
  setResiduals(part, h);
  mixing_.reset();
  return true;
}

/// Closes the remaining gaps with the matrix of each iterate. Returns the number of rows without a pivot in the first.
int RattleStep::closeWeakRows(const Part& part, const State& state, double h) {
  relinearised_[at(part.index)] = 1;
  mixing_.takeBest(part, mean_);
  mixing_.reset();
  moveTrial(part, state, h);
  updateAxes(part, h);
  const int lost = linearise(part, trial_);
  setResiduals(part, h);
  for (const int node : part.bodies) x_[at(node)] = {};
  return lost;
}

void RattleStep::fail(const Part& part, const State& state, double gap, double h) const {
  int worst = -1, worstRow = 0;
  double most = 0;
  for (const int k : part.constraints) {
    double error[6];
    positionError(system_.constraints()[at(k)], trialFrames_[at(k)], error);
    for (int r = 0; r < 6; ++r)
      if ((hardRows(system_.constraints()[at(k)].kind) >> r & 1u) && !(std::fabs(error[r]) <= most))
        most = std::fabs(error[r]), worst = k, worstRow = r;
  }
  std::ostringstream message;
  message << "multibody step from t = " << state.time << " s";
  if (worst >= 0) message << ": " << system_.describe(worst, worstRow) << " remains open by " << most << " [m or rad]";
  message << " (largest residual " << gap << ") after " << options_.maxIterations
          << " iterations; the motion is too fast for a stage of " << h
          << " s: reduce the step, or check loads, drives and whether the mechanism can reach the driven position";
  throw base::SimulationError(message.str(), base::Cause::fastMotion);
}

} // namespace grouser::multibody::detail
