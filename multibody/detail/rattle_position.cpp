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

/// Axis positions at the current iterate, and the softness 1/G of the soft rows there. Returns whether it has moved so
/// far from what the matrix holds that the matrix must follow: Newton's method tolerates a small part of G + J M^-1
/// J^T.
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
      // A row that lets go stays in the system, or its impulse could not vanish.
      if (law.softness != 0 && std::fabs(now) * size < 1e-3) now = 1e-3 / size;
      if (std::fabs(now - law.softness) * size <= 0.05 * (1 + std::fabs(law.softness) * size)) continue;
      law.softness = now;
      follow = true;
    }
  }
  return follow;
}

void RattleStep::solvePositions(const Part& part, const State& state, const Loads& loads, double h) {
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
      laws[at(a)].softness = soft[at(a)].driven ? 0 : 0.5 * h * h * meanForce(a, h).slope;
    }
  }
  int lost = positionsFactored(part) ? 0 : linearise(part, frames); // rows that have no pivot
  factored[at(part.index)] = -1;
  relinearised[at(part.index)] = 0;
  // Soft rows are predicted along their tangent: a stiff spring must not be asked what it does where the velocity of
  // the node alone would take it.
  for (const int k : part.constraints)
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      if (laws[at(a)].softness != 0) x1[at(a)] = x0[at(a)] + h * system.rateOfAxis(a, mean);
      if (soft[at(a)].driven) startRate[at(a)] = system.rateOfAxis(a, mean);
    }
  setFirstResidual(part, state, loads, h);
  setResiduals(part, h);

  double scale = 0;
  for (const int node : part.bodies) {
    const Vec3d& p = state.pose[at(system.bodyOf(node))].position;
    scale = std::max({scale, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  }
  // Below a few units in the last place of the coordinates there is nothing to gain.
  const double tolerance = std::max(options.positionTolerance, kRoundOff * scale);
  double before = std::numeric_limits<double>::infinity(), best = before;
  mixing.reset();
  Phase phase = Phase::kAllRows;
  int since = 0; // iterations of this phase
  const auto enter = [&](Phase next) {
    phase = next, since = 0, best = before = std::numeric_limits<double>::infinity();
  };
  const int limit = options.maxIterations;
  for (int iteration = 1;; ++iteration) {
    system.solve(part, x);
    if (mixing.on() && !relinearised[at(part.index)]) mixing.improve(part, {mean, impulse, couplingImpulse}, x);
    applyCorrection(part, h);
    moveTrial(part, state, h);
    const bool follow = updateAxes(part, h);
    const double gap = setResiduals(part, h), open = gapOf[at(part.index)];
    last.iterations = std::max(last.iterations, iteration);
    ++since;
    // A little above the tolerance and not getting better is round-off.
    const bool done = !follow && (gap <= tolerance || (std::min(best, gap) <= 1e2 * tolerance && gap > 0.5 * before));
    const bool slow = since > 1 && !(gap <= 0.2 * before);
    const bool closed = lost == 0 || open <= 1e2 * tolerance;
    best = std::min(best, gap);
    before = gap;
    if (phase == Phase::kAllRows) {
      if (done && closed) break;
      mixing.remember(part, gap, mean);
      if ((done || slow) && !mixing.on() && startWithoutWeakRows(part, state, loads, h)) {
        enter(Phase::kWithoutWeakRows);
      } else if (done) {
        break;
      } else if (since >= limit) {
        enter(Phase::kEachIterate);
      } else if (follow) {
        lost = std::max(lost, linearise(part, frames));
        mixing.forget();
      } else if (slow && !mixing.on()) {
        mixing.switchOn();
      }
    } else if (phase == Phase::kWithoutWeakRows) {
      if (done || since >= limit || (since > 2 && slow)) {
        // From here the others have a short way to go, and to the solution that inertia leads to.
        mixing.reset();
        mixing.remember(part, gap, mean);
        system.scalePivotThreshold(firmPivotScale(options.positionTolerance));
        linearise(part, frames);
        system.scalePivotThreshold(1);
        mixing.switchOn();
        enter(Phase::kMixed);
      }
    } else if (phase == Phase::kMixed) {
      if (done && open <= 1e2 * tolerance) break;
      if (done || since >= 2 * limit || !std::isfinite(gap)) enter(Phase::kEachIterate);
    } else {
      if (done) break;
      if (since >= 2 * limit) {
        // Where rows have lost their pivot the rest may stay a little open; they close behind the singular position.
        if (!(gap <= (lost > 0 ? kGapFailure : 1e3 * tolerance))) fail(part, state, gap, h);
        break;
      }
    }
    if (phase != Phase::kEachIterate) continue;
    const int lostHere = since == 0 ? closeWeakRows(part, state, h) : linearise(part, trial);
    lost = std::max(lost, lostHere);
  }
  // Also of rows that had no pivot.
  if (!(gapOf[at(part.index)] <= kGapFailure)) fail(part, state, gapOf[at(part.index)], h);
  last.maxPositionError = std::max(last.maxPositionError, gapOf[at(part.index)]);
  collectMomentum(part, state, loads, h);
}

void RattleStep::setFirstResidual(const Part& part, const State& state, const Loads& loads, double h) {
  for (const int node : part.bodies) {
    const int b = system.bodyOf(node);
    const Wrench& wrench = loads.external[at(b)];
    const Mat3d& I = system.inertia(node);
    const Vec3d& w = mean[at(b)].w;
    gyro[at(node)] = gyroscopicMomentum(I, w, h);
    set(x[at(node)], 0.5 * h * (wrench.force + model.bodies()[at(b)].mass * loads.gravity),
        (state.spinMomentum[at(b)] - I * w) - gyro[at(node)] + 0.5 * h * wrench.torque);
  }
  for (const int k : part.constraints) {
    impulse[at(k)] = {};
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      const std::size_t row = at(system.axes()[at(a)].row);
      softImpulse[at(a)] = 0.5 * h * meanForce(a, h).force;
      const double known = 0.5 * h * (nodeForce(soft[at(a)], x0[at(a)]) + soft[at(a)].applied0);
      // A soft row's impulse is an unknown of the system; without softness it is known.
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
  double largest = 0, open = 0;
  // Written so that a gap that is not a number counts as the largest.
  const auto take = [](double& most, double gap) {
    if (!(std::fabs(gap) <= most)) most = std::fabs(gap);
  };
  for (const int k : part.constraints) {
    double error[6];
    positionError(system.constraints()[at(k)], trialFrames[at(k)], error);
    Vector6& residual = x[at(rowNode(k))];
    residual = {};
    const unsigned hard = hardRows(system.constraints()[at(k)].kind), kept = system.elimination().keptRows(k);
    for (int r = 0; r < 6; ++r) {
      if (!(hard >> r & 1u)) continue;
      residual[at(r)] = -error[r] / h;
      take(open, error[r]);
      if (kept >> r & 1u) take(largest, error[r]);
    }
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      const int row = system.axes()[at(a)].row;
      const SoftRow& s = soft[at(a)];
      if (s.driven) {
        const double gap = x1[at(a)] - (s.relative ? x0[at(a)] + s.target : s.target);
        residual[at(row)] = -gap / h;
        take(open, gap);
        if (kept >> row & 1u) take(largest, gap);
      } else if (laws[at(a)].softness != 0) {
        residual[at(row)] = (0.5 * h * meanForce(a, h).force - impulse[at(k)][at(row)]) / laws[at(a)].softness;
        // In terms of position: what the soft row and the masses behind it would still move.
        const double softness = std::fabs(laws[at(a)].softness) * system.rowSize(k, row);
        take(largest, residual[at(row)] * h * softness / (1 + softness));
      }
    }
  }
  for (const int c : part.couplings) {
    const CouplingRow& row = system.couplings()[at(c)];
    const double gap = x1[at(row.axis2)] - row.ratio * x1[at(row.axis1)] - row.offset;
    x[at(system.couplingNode(c))] = {};
    x[at(system.couplingNode(c))][0] = -gap / h;
    take(open, gap);
    if (system.couplingKept(c)) take(largest, gap);
  }
  gapOf[at(part.index)] = open;
  if (relinearised[at(part.index)]) return largest;
  for (const int node : part.bodies) {
    const Mat3d& I = system.inertia(node);
    const Vec3d g = gyroscopicMomentum(I, mean[at(system.bodyOf(node))].w, h);
    const Vec3d residual = gyro[at(node)] - g;
    gyro[at(node)] = g;
    add(x[at(node)], {}, residual);
    take(largest, h * 3 / (I.m[0][0] + I.m[1][1] + I.m[2][2]) * norm(residual));
  }
  return largest;
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
      V.w = twistOfSpin(I, I * V.w + gyro[at(node)], V.w, h);
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
    spin[at(node)] = state.spinMomentum[at(b)] + 0.5 * h * loads.external[at(b)].torque;
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
