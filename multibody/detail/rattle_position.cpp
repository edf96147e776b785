// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/rattle_step.hpp"

#include "multibody/detail/axis_laws.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/rotation.hpp"
#include "multibody/detail/vector6.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

/// First half of a stage of RATTLE (the scheme is in rattle_step.cpp), u and Lambda such that C(q_1) = 0: its unknowns
/// and residuals. rattle_phases.cpp solves for them.
namespace grouser::multibody::detail {

namespace {

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

} // namespace grouser::multibody::detail
