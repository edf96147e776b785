// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/rattle_step.hpp"

#include "base/error.hpp"
#include "multibody/detail/axis_laws.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/rotation.hpp"
#include "multibody/detail/vector6.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>

/// First half of a stage of RATTLE (the scheme is in rattle_step.cpp): u and Lambda such that C(q_1) = 0.
namespace grouser::multibody::detail {

namespace {

/// Gaps are not closed further than this part of the coordinates.
constexpr double kRoundOff = 5e-16;

/// In units of the tolerance: up to where a gap that iterations no longer reduce is round-off, which a long loop sums
/// up; and the gap that is accepted when no phase is left to try (1e-12 m or rad by default).
constexpr double kNearTolerance = 1e2, kAcceptable = 1e3;

/// Of an iteration, new gap over the one before. Newton's method with the matrix of the start takes a gap down by
/// h |w|, some 1e-2 in a step that is worth taking: above a fifth something else than curvature is at work, and help
/// costs less than going on. Round-off does not even halve it.
constexpr double kSlowConvergence = 0.2, kStalled = 0.5;

/// Of soft rows, in units of the row's own J M^-1 J^T: inverse compliance that a row which lets go keeps, so that its
/// impulse can vanish; and change, as a part of both together, that Newton's method tolerates without a new matrix.
constexpr double kLeastInverseCompliance = 1e-3, kComplianceChange = 0.05;

/// Turn of a stage times the spread of the inertia [rad] above which each body's own gyroscopic equation is solved by
/// Newton's method within the iteration, to round-off: what a tolerance would leave has the same sign in each step, and
/// would turn the body by its share of the tolerance over the step's square. Below, two iterations leave less.
constexpr double kFastSpin = 1e-7;

} // namespace

/// Mean force of an axis' implicit part, and its slope D.
ForceAndSlope RattleStep::meanForce(int axis, double h) const {
  const SoftRow& row = soft[at(axis)];
  const double a = x0[at(axis)], b = x1[at(axis)];
  ForceAndSlope f;
  if (implicitSprings) {
    f.force = row.constant - 0.5 * row.stiffness * (a + b);
    f.slope = 0.5 * row.stiffness;
  }
  if (row.damping != 0) {
    f.force -= row.damping * (b - a) / h;
    f.slope += row.damping / h;
  }
  if (row.stops) {
    const ForceAndSlope s = softRows.stops(axis, a, b, h);
    f.force += s.force;
    f.slope += s.slope;
  }
  return f;
}

/// Axis positions at the current iterate, and the inverse compliance 1/G of the soft rows there. Returns whether it has
/// moved so far from what the matrix holds that the matrix must follow: Newton's method tolerates a small part of G + J
/// M^-1 J^T.
bool RattleStep::updateAxes(const Part& part, double h) {
  bool follow = false;
  for (const int k : part.constraints) {
    const Constraint& c = system.constraints()[at(k)];
    placeFrames(c, trial[at(c.bodyA)], trial[at(c.bodyB)], trialFrames[at(k)]);
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      const int row = system.axes()[at(a)].row;
      x1[at(a)] = axisPositionAfter(c, startFrames[at(k)], trialFrames[at(k)], row, x0[at(a)]);
      if (soft[at(a)].driven || !soft[at(a)].stops) continue; // all else is linear
      AxisLaw& law = laws[at(a)];
      const double size = system.rowSize(k, row);
      double now = 0.5 * h * h * meanForce(a, h).slope;
      if (law.inverseCompliance != 0 && std::fabs(now) * size < kLeastInverseCompliance)
        now = kLeastInverseCompliance / size;
      if (std::fabs(now - law.inverseCompliance) * size <=
          kComplianceChange * (1 + std::fabs(law.inverseCompliance) * size))
        continue;
      law.inverseCompliance = now;
      follow = true;
    }
  }
  return follow;
}

void RattleStep::solvePositions(const Part& part, const State& state, const Loads& loads, double h) {
  PositionSolve solve;
  solve.tolerance = gapTolerance(part, state);
  startAxes(part, state, h);
  solve.lost = positionsFactored(part) ? 0 : linearise(part, frames);
  factored[at(part.index)] = -1;
  relinearised[at(part.index)] = 0;
  predictSoftRows(part, h);
  setFirstResidual(part, state, loads, h);
  setResiduals(part, h);

  mixing.reset();
  for (bool solved = false; !solved;) {
    iterate(part, state, h, solve);
    solved = advance(part, state, loads, h, solve);
    if (solved || solve.phase != Phase::kEachIterate) continue;
    const int lostHere = solve.since == 0 ? closeWeakRows(part, state, h) : linearise(part, trial);
    solve.lost = std::max(solve.lost, lostHere);
  }
  // Also of rows that had no pivot.
  if (!(gapOf[at(part.index)] <= kGapFailure)) fail(part, state, gapOf[at(part.index)], h);
  last.maxPositionError = std::max(last.maxPositionError, gapOf[at(part.index)]);
  collectMomentum(part, state, loads, h);
}

/// Below a few units in the last place of the coordinates there is nothing to gain.
double RattleStep::gapTolerance(const Part& part, const State& state) const {
  double scale = 0;
  for (const int node : part.bodies) {
    const Vec3d& p = state.pose[at(system.bodyOf(node))].position;
    scale = std::max({scale, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  }
  return std::max(options.positionTolerance, kRoundOff * scale);
}

/// First iterate: the twists of the node; where axes are then, and how soft.
void RattleStep::startAxes(const Part& part, const State& state, double h) {
  for (const int node : part.bodies) mean[at(system.bodyOf(node))] = state.twist[at(system.bodyOf(node))];
  moveTrial(part, state, h);
  for (const int k : part.constraints) {
    const Constraint& c = system.constraints()[at(k)];
    placeFrames(c, frames[at(c.bodyA)], frames[at(c.bodyB)], startFrames[at(k)]);
    placeFrames(c, trial[at(c.bodyA)], trial[at(c.bodyB)], trialFrames[at(k)]);
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      const int row = system.axes()[at(a)].row;
      x0[at(a)] = isJoint(c.kind) ? axisPositionIn(state, system, a) : axisPosition(c, startFrames[at(k)], row);
      x1[at(a)] = axisPositionAfter(c, startFrames[at(k)], trialFrames[at(k)], row, x0[at(a)]);
      laws[at(a)] = {};
      laws[at(a)].driven = soft[at(a)].driven;
      laws[at(a)].inverseCompliance = soft[at(a)].driven ? 0 : 0.5 * h * h * meanForce(a, h).slope;
    }
  }
}

/// Soft rows are predicted along their tangent: a stiff spring must not be asked what it does where the velocity of the
/// node alone would take it.
void RattleStep::predictSoftRows(const Part& part, double h) {
  for (const int k : part.constraints)
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      if (laws[at(a)].inverseCompliance != 0) x1[at(a)] = x0[at(a)] + h * system.rateOfAxis(a, mean);
      if (soft[at(a)].driven) startRate[at(a)] = system.rateOfAxis(a, mean);
    }
}

/// One iteration of Newton's method, and how it went.
void RattleStep::iterate(const Part& part, const State& state, double h, PositionSolve& solve) {
  system.solve(part, x);
  if (mixing.on() && !relinearised[at(part.index)]) mixing.improve(part, {mean, impulse, couplingImpulse}, x);
  applyCorrection(part, h);
  moveTrial(part, state, h);
  solve.follow = updateAxes(part, h);
  solve.gap = setResiduals(part, h);
  solve.open = gapOf[at(part.index)];
  ++solve.iterations, ++solve.since;
  last.iterations = std::max(last.iterations, solve.iterations);

  // A little above the tolerance and not getting better is round-off.
  const bool atRoundOff =
      std::min(solve.best, solve.gap) <= kNearTolerance * solve.tolerance && solve.gap > kStalled * solve.before;
  solve.done = !solve.follow && (solve.gap <= solve.tolerance || atRoundOff);
  solve.slow = solve.since > 1 && !(solve.gap <= kSlowConvergence * solve.before);
  solve.best = std::min(solve.best, solve.gap);
  solve.before = solve.gap;
}

/// What to do after an iteration: returns whether the stage's positions are found, or enters the next phase.
bool RattleStep::advance(const Part& part, const State& state, const Loads& loads, double h, PositionSolve& solve) {
  switch (solve.phase) {
  case Phase::kAllRows:
    return advanceAllRows(part, state, loads, h, solve);
  case Phase::kWithoutWeakRows:
    advanceWithoutWeakRows(part, solve);
    return false;
  case Phase::kMixed:
    if (solve.done && solve.open <= kNearTolerance * solve.tolerance) return true;
    if (solve.done || solve.since >= 2 * options.maxIterations || !std::isfinite(solve.gap))
      solve.enter(Phase::kEachIterate);
    return false;
  case Phase::kEachIterate:
    break;
  }
  if (solve.done) return true;
  if (solve.since < 2 * options.maxIterations) return false;
  // Where rows have lost their pivot the rest may stay a little open; they close behind the singular position.
  if (!(solve.gap <= (solve.lost > 0 ? kGapFailure : kAcceptable * solve.tolerance))) fail(part, state, solve.gap, h);
  return true;
}

/// All rows, with the matrix of the start of the stage: all that nearly every step needs.
bool RattleStep::advanceAllRows(const Part& part, const State& state, const Loads& loads, double h,
                                PositionSolve& solve) {
  const bool closed = solve.lost == 0 || solve.open <= kNearTolerance * solve.tolerance;
  if (solve.done && closed) return true;
  mixing.remember(part, solve.gap, mean);
  if ((solve.done || solve.slow) && !mixing.on() && startWithoutWeakRows(part, state, loads, h)) {
    solve.enter(Phase::kWithoutWeakRows);
  } else if (solve.done) {
    return true;
  } else if (solve.since >= options.maxIterations) {
    solve.enter(Phase::kEachIterate);
  } else if (solve.follow) {
    solve.lost = std::max(solve.lost, linearise(part, frames));
    mixing.forget();
  } else if (solve.slow && !mixing.on()) {
    mixing.switchOn();
  }
  return false;
}

/// Without the weak rows until that has led to where inertia takes the bodies; from there the others have a short way
/// to go, and to the solution that inertia leads to.
void RattleStep::advanceWithoutWeakRows(const Part& part, PositionSolve& solve) {
  if (!solve.done && solve.since < options.maxIterations && !(solve.since > 2 && solve.slow)) return;
  mixing.reset();
  mixing.remember(part, solve.gap, mean);
  system.scalePivotThreshold(firmPivotScale(options.positionTolerance));
  linearise(part, frames);
  system.scalePivotThreshold(1);
  mixing.switchOn();
  solve.enter(Phase::kMixed);
}

void RattleStep::setFirstResidual(const Part& part, const State& state, const Loads& loads, double h) {
  for (const int node : part.bodies) {
    const int b = system.bodyOf(node);
    const Wrench& wrench = loads.external[at(b)];
    const Mat3d& I = system.inertia(node);
    const Vec3d& w = mean[at(b)].w;
    gyro[at(node)] = gyroscopicMomentum(I, w, h);
    set(x[at(node)], 0.5 * h * (wrench.force + model.bodies()[at(b)].mass * loads.gravity),
        (state.angularMomentum[at(b)] - I * w) - gyro[at(node)] + 0.5 * h * wrench.torque);
  }
  for (const int k : part.constraints) {
    impulse[at(k)] = {};
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      const std::size_t row = at(system.axes()[at(a)].row);
      softImpulse[at(a)] = 0.5 * h * meanForce(a, h).force;
      const double known = 0.5 * h * (nodeForce(soft[at(a)], x0[at(a)]) + soft[at(a)].applied0);
      // A soft row's impulse is an unknown of the system; without compliance it is known.
      impulse[at(k)][row] = softImpulse[at(a)];
      if (known + softImpulse[at(a)] != 0) system.addImpulse(k, static_cast<int>(row), known + softImpulse[at(a)], x);
    }
  }
  for (const int c : part.couplings) couplingImpulse[at(c)] = 0;
}

void RattleStep::moveTrial(const Part& part, const State& state, double h) {
  for (const int node : part.bodies) {
    const int b = system.bodyOf(node);
    const Pose& X = state.pose[at(b)];
    trialPose[at(b)].position = X.position + h * mean[at(b)].v;
    trialPose[at(b)].orientation = (rotationBy(h * mean[at(b)].w) * X.orientation).normalized();
    system.placeBody(b, trialPose[at(b)], trial);
  }
}

double RattleStep::setResiduals(const Part& part, double h) {
  Gaps gaps;
  for (const int k : part.constraints) setResidual(k, h, gaps);
  for (const int c : part.couplings) {
    const CouplingRow& row = system.couplings()[at(c)];
    const double gap = x1[at(row.axis2)] - row.ratio * x1[at(row.axis1)] - row.offset;
    x[at(system.couplingNode(c))] = {};
    x[at(system.couplingNode(c))][0] = -gap / h;
    gaps.take(gap, system.couplingKept(c));
  }
  gapOf[at(part.index)] = gaps.open;
  if (relinearised[at(part.index)]) return gaps.largest;
  for (const int node : part.bodies) {
    const Mat3d& I = system.inertia(node);
    const Vec3d g = gyroscopicMomentum(I, mean[at(system.bodyOf(node))].w, h);
    const Vec3d residual = gyro[at(node)] - g;
    gyro[at(node)] = g;
    add(x[at(node)], {}, residual);
    Gaps::takeLarger(gaps.largest, h * 3 / (I.m[0][0] + I.m[1][1] + I.m[2][2]) * norm(residual));
  }
  return gaps.largest;
}

/// Residuals of the rows of one constraint.
void RattleStep::setResidual(int k, double h, Gaps& gaps) {
  double error[6];
  positionError(system.constraints()[at(k)], trialFrames[at(k)], error);
  Vector6& residual = x[at(rowNode(k))];
  residual = {};
  const unsigned hard = hardRows(system.constraints()[at(k)].kind), kept = system.elimination().keptRows(k);
  for (int r = 0; r < 6; ++r) {
    if (!(hard >> r & 1u)) continue;
    residual[at(r)] = -error[r] / h;
    gaps.take(error[r], kept >> r & 1u);
  }
  for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
    const int row = system.axes()[at(a)].row;
    const SoftRow& s = soft[at(a)];
    if (s.driven) {
      const double gap = x1[at(a)] - (s.relative ? x0[at(a)] + s.target : s.target);
      residual[at(row)] = -gap / h;
      gaps.take(gap, kept >> row & 1u);
    } else if (laws[at(a)].inverseCompliance != 0) {
      residual[at(row)] = (0.5 * h * meanForce(a, h).force - impulse[at(k)][at(row)]) / laws[at(a)].inverseCompliance;
      // In terms of position: what the soft row and the masses behind it would still move.
      const double inverseCompliance = std::fabs(laws[at(a)].inverseCompliance) * system.rowSize(k, row);
      Gaps::takeLarger(gaps.largest, residual[at(row)] * h * inverseCompliance / (1 + inverseCompliance));
    }
  }
}

/// The solve anew from the old twist, without the rows whose pivot a turn of this size can take through zero: near a
/// singular position those would need huge impulses on the way, and spoil the rest. What they leave open is second
/// order in a motion across the singular direction, hence small. Returns whether there are any; if not, nothing has
/// changed.
bool RattleStep::startWithoutWeakRows(const Part& part, const State& state, const Loads& loads, double h) {
  double turn = 0;
  for (const int node : part.bodies) turn = std::max(turn, std::fabs(h) * norm(state.twist[at(system.bodyOf(node))].w));
  system.scalePivotThreshold(weakPivotScale(turn));
  const int weak = system.linearise(part, frames, laws);
  system.scalePivotThreshold(1);
  if (weak == 0) {
    system.linearise(part, frames, laws);
    return false;
  }
  for (const int node : part.bodies) mean[at(system.bodyOf(node))] = state.twist[at(system.bodyOf(node))];
  moveTrial(part, state, h);
  updateAxes(part, h);
  setFirstResidual(part, state, loads, h);
  setResiduals(part, h);
  mixing.reset();
  return true;
}

/// Closes what is left with the matrix of each iterate. Returns the rows without a pivot in the first.
int RattleStep::closeWeakRows(const Part& part, const State& state, double h) {
  relinearised[at(part.index)] = 1;
  mixing.takeBest(part, mean);
  mixing.reset();
  moveTrial(part, state, h);
  updateAxes(part, h);
  const int lost = linearise(part, trial);
  setResiduals(part, h);
  for (const int node : part.bodies) x[at(node)] = {};
  return lost;
}

void RattleStep::applyCorrection(const Part& part, double h) {
  for (const int node : part.bodies) {
    Twist& V = mean[at(system.bodyOf(node))];
    V.v += linear(x[at(node)]);
    V.w += angular(x[at(node)]);
    x[at(node)] = {};
    if (relinearised[at(part.index)]) continue;
    // The momentum that the new impulses leave is I w + the gyroscopic part of the iterate before.
    const Mat3d& I = system.inertia(node);
    if (std::fabs(h) * norm(V.w) * inertiaSpread[at(node)] > kFastSpin) {
      V.w = angularVelocityOf(I, I * V.w + gyro[at(node)], V.w, h);
      gyro[at(node)] = gyroscopicMomentum(I, V.w, h); // solved: nothing is left for the next iterate
    }
  }
  for (const int k : part.constraints)
    for (std::size_t r = 0; r < 6; ++r) impulse[at(k)][r] += x[at(rowNode(k))][r];
  for (const int c : part.couplings) couplingImpulse[at(c)] += x[at(system.couplingNode(c))][0];
}

/// Spin after the first half kick: the sum of the impulses, so that it is conserved to the last digits; where the rows
/// were taken anew, what the mean twist says.
void RattleStep::collectMomentum(const Part& part, const State& state, const Loads& loads, double h) {
  if (relinearised[at(part.index)]) {
    for (const int node : part.bodies) {
      const int b = system.bodyOf(node);
      const Mat3d I = rotatedInertia(frames[at(b)].R, model.bodies()[at(b)].inertia_B);
      spin[at(node)] = I * mean[at(b)].w + gyroscopicMomentum(I, mean[at(b)].w, h);
    }
    return;
  }
  for (const int node : part.bodies) {
    const int b = system.bodyOf(node);
    spin[at(node)] = state.angularMomentum[at(b)] + 0.5 * h * loads.external[at(b)].torque;
    x[at(node)] = {};
  }
  for (const int k : part.constraints) {
    for (int r = 0; r < 6; ++r)
      if (const double total = impulse[at(k)][at(r)]; total != 0) system.addImpulse(k, r, total, x);
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      const double known = 0.5 * h * (nodeForce(soft[at(a)], x0[at(a)]) + soft[at(a)].applied0);
      if (known != 0) system.addImpulse(k, system.axes()[at(a)].row, known, x);
    }
  }
  for (const int c : part.couplings) {
    const CouplingRow& row = system.couplings()[at(c)];
    const Axis &one = system.axes()[at(row.axis1)], &two = system.axes()[at(row.axis2)];
    system.addImpulse(two.constraint, two.row, couplingImpulse[at(c)], x);
    system.addImpulse(one.constraint, one.row, -row.ratio * couplingImpulse[at(c)], x);
  }
  for (const int node : part.bodies) spin[at(node)] += angular(x[at(node)]);
}

void RattleStep::fail(const Part& part, const State& state, double gap, double h) const {
  int worst = -1, worstRow = 0;
  double most = 0;
  for (const int k : part.constraints) {
    double error[6];
    positionError(system.constraints()[at(k)], trialFrames[at(k)], error);
    for (int r = 0; r < 6; ++r)
      if ((hardRows(system.constraints()[at(k)].kind) >> r & 1u) && !(std::fabs(error[r]) <= most))
        most = std::fabs(error[r]), worst = k, worstRow = r;
  }
  std::ostringstream message;
  message << "multibody step from t = " << state.time << " s";
  if (worst >= 0) message << ": " << system.describe(worst, worstRow) << " stays open by " << most << " [m or rad]";
  message << " (largest residual " << gap << ") after " << options.maxIterations
          << " iterations; the motion is too fast for a stage of " << h
          << " s: reduce the step, or check loads, drives and whether the mechanism can reach where it is driven";
  throw base::SimulationError(message.str());
}

} // namespace grouser::multibody::detail
