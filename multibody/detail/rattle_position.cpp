// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/rattle_step.hpp"

#include "multibody/detail/axis_laws.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/rotation.hpp"
#include "multibody/detail/vector6.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

/// Unknowns u and Lambda, and residuals, of the first half of a stage of RATTLE, which satisfies C(q_1) = 0 (scheme:
/// rattle_step.cpp). rattle_phases.cpp solves for the unknowns.
namespace grouser::multibody::detail {

namespace {

/// Soft rows, in units of the row's own J M^-1 J^T: minimum inverse compliance of a row that loses contact, so that its
/// impulse can vanish; and relative change that Newton's method tolerates without a new matrix.
constexpr double kMinInverseCompliance = 1e-3, kComplianceChange = 0.05;

/// Rotation in a stage times the spread of the inertia [rad] above which the gyroscopic equation of each body is solved
/// by Newton's method within the iteration, to round-off: an error within a tolerance would have the same sign in each
/// step and accumulate. Below this value, two iterations are more accurate.
constexpr double kFreeSpin = 1e-7;

} // namespace

/// Mean force of an axis' implicit part, and its slope D.
ForceAndSlope RattleStep::meanForce(int axis, double h) const {
  const SoftRow& row = soft_[at(axis)];
  const double a = x0_[at(axis)], b = x1_[at(axis)];
  ForceAndSlope f;
  if (implicitSprings_) {
    f.force = row.constant - 0.5 * row.stiffness * (a + b);
    f.slope = 0.5 * row.stiffness;
  }
  if (row.damping != 0) {
    f.force -= row.damping * (b - a) / h;
    f.slope += row.damping / h;
  }
  if (row.stops) {
    const ForceAndSlope s = softRows_.stops(axis, a, b, h);
    f.force += s.force;
    f.slope += s.slope;
  }
  return f;
}

/// Axis positions at the current iterate, and the inverse compliance 1/G of the soft rows there. Returns true if G
/// differs too much from the factored matrix: Newton's method tolerates a small part of G + J M^-1 J^T.
bool RattleStep::updateAxes(const Part& part, double h) {
  bool follow = false;
  for (const int k : part.constraints) {
    const Constraint& c = system_.constraints()[at(k)];
    placeFrames(c, trial_[at(c.bodyA)], trial_[at(c.bodyB)], trialFrames_[at(k)]);
    for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a) {
      const int row = system_.axes()[at(a)].row;
      x1_[at(a)] = axisPositionAfter(c, startFrames_[at(k)], trialFrames_[at(k)], row, x0_[at(a)]);
      if (soft_[at(a)].driven || !soft_[at(a)].stops) continue; // everything else is linear
      AxisLaw& law = laws_[at(a)];
      const double size = system_.rowSize(k, row);
      double now = 0.5 * h * h * meanForce(a, h).slope;
      if ((law.inverseCompliance != 0 || now != 0) && std::fabs(now) * size < kMinInverseCompliance)
        now = kMinInverseCompliance / size;
      // A stop first touched within the stage needs its own unknown, even if it is soft: otherwise it would store
      // energy without work.
      const bool begins = law.inverseCompliance == 0 && now != 0;
      if (!begins && std::fabs(now - law.inverseCompliance) * size <=
                         kComplianceChange * (1 + std::fabs(law.inverseCompliance) * size))
        continue;
      law.inverseCompliance = now;
      follow = true;
    }
  }
  return follow;
}

/// First iterate: the twists of the node, with axis positions and compliances.
void RattleStep::startAxes(const Part& part, const State& state, double h) {
  for (const int node : part.bodies) mean_[at(system_.bodyOf(node))] = state.twist[at(system_.bodyOf(node))];
  moveTrial(part, state, h);
  for (const int k : part.constraints) {
    const Constraint& c = system_.constraints()[at(k)];
    placeFrames(c, frames_[at(c.bodyA)], frames_[at(c.bodyB)], startFrames_[at(k)]);
    placeFrames(c, trial_[at(c.bodyA)], trial_[at(c.bodyB)], trialFrames_[at(k)]);
    for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a) {
      const int row = system_.axes()[at(a)].row;
      x0_[at(a)] = isJoint(c.kind) ? axisPositionIn(state, system_, a) : axisPosition(c, startFrames_[at(k)], row);
      x1_[at(a)] = axisPositionAfter(c, startFrames_[at(k)], trialFrames_[at(k)], row, x0_[at(a)]);
      laws_[at(a)] = {};
      laws_[at(a)].driven = soft_[at(a)].driven;
      laws_[at(a)].inverseCompliance = soft_[at(a)].driven ? 0 : 0.5 * h * h * meanForce(a, h).slope;
    }
  }
}

/// Predicts soft rows along their tangent: the force of a stiff spring must not be evaluated at the position that its
/// axis would reach with the velocity at the node.
void RattleStep::predictSoftRows(const Part& part, double h) {
  for (const int k : part.constraints)
    for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a) {
      if (laws_[at(a)].inverseCompliance != 0) x1_[at(a)] = x0_[at(a)] + h * system_.rateOfAxis(a, mean_);
      if (soft_[at(a)].driven) startRate_[at(a)] = system_.rateOfAxis(a, mean_);
    }
}

void RattleStep::setFirstResidual(const Part& part, const State& state, const Loads& loads, double h) {
  for (const int node : part.bodies) {
    const int b = system_.bodyOf(node);
    const Wrench& wrench = loads.external[at(b)];
    const Mat3d& I = system_.inertia(node);
    const Vec3d& w = mean_[at(b)].w;
    gyro_[at(node)] = gyroscopicMomentum(I, w, h);
    set(x_[at(node)], 0.5 * h * (wrench.force + model_.bodies()[at(b)].mass * loads.gravity),
        (state.angularMomentum[at(b)] - I * w) - gyro_[at(node)] + 0.5 * h * wrench.torque);
  }
  for (const int k : part.constraints) {
    impulse_[at(k)] = {};
    for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a) {
      const std::size_t row = at(system_.axes()[at(a)].row);
      softImpulse_[at(a)] = 0.5 * h * meanForce(a, h).force;
      const double known = 0.5 * h * (nodeForce(soft_[at(a)], x0_[at(a)]) + soft_[at(a)].applied0);
      // A soft row's impulse is an unknown of the system; without compliance it is known.
      impulse_[at(k)][row] = softImpulse_[at(a)];
      if (known + softImpulse_[at(a)] != 0)
        system_.addImpulse(k, static_cast<int>(row), known + softImpulse_[at(a)], x_);
    }
  }
  for (const int c : part.couplings) couplingImpulse_[at(c)] = 0;
}

void RattleStep::moveTrial(const Part& part, const State& state, double h) {
  for (const int node : part.bodies) {
    const int b = system_.bodyOf(node);
    const Pose& X = state.pose[at(b)];
    trialPose_[at(b)].position = X.position + h * mean_[at(b)].v;
    trialPose_[at(b)].orientation = (rotationBy(h * mean_[at(b)].w) * X.orientation).normalized();
    system_.placeBody(b, trialPose_[at(b)], trial_);
  }
}

double RattleStep::setResiduals(const Part& part, double h) {
  Gaps gaps;
  for (const int k : part.constraints) setResidual(k, h, gaps);
  for (const int c : part.couplings) {
    const CouplingRow& row = system_.couplings()[at(c)];
    const double gap = x1_[at(row.axis2)] - row.ratio * x1_[at(row.axis1)] - row.offset;
    x_[at(system_.couplingNode(c))] = {};
    x_[at(system_.couplingNode(c))][0] = -gap / h;
    gaps.take(gap, system_.couplingKept(c));
  }
  gapOf_[at(part.index)] = gaps.open;
  if (relinearised_[at(part.index)]) return gaps.largest;
  for (const int node : part.bodies) {
    const Mat3d& I = system_.inertia(node);
    const Vec3d g = gyroscopicMomentum(I, mean_[at(system_.bodyOf(node))].w, h);
    const Vec3d residual = gyro_[at(node)] - g;
    gyro_[at(node)] = g;
    add(x_[at(node)], {}, residual);
    Gaps::takeLarger(gaps.largest, h * 3 / (I.m[0][0] + I.m[1][1] + I.m[2][2]) * norm(residual));
  }
  return gaps.largest;
}

/// Residuals of the rows of one constraint.
void RattleStep::setResidual(int k, double h, Gaps& gaps) {
  double error[6];
  positionError(system_.constraints()[at(k)], trialFrames_[at(k)], error);
  Vector6& residual = x_[at(rowNode(k))];
  residual = {};
  const unsigned hard = hardRows(system_.constraints()[at(k)].kind), kept = system_.elimination().keptRows(k);
  for (int r = 0; r < 6; ++r) {
    if (!(hard >> r & 1u)) continue;
    residual[at(r)] = -error[r] / h;
    gaps.take(error[r], kept >> r & 1u);
  }
  for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a) {
    const int row = system_.axes()[at(a)].row;
    const SoftRow& s = soft_[at(a)];
    if (s.driven) {
      const double gap = x1_[at(a)] - (s.relative ? x0_[at(a)] + s.target : s.target);
      residual[at(row)] = -gap / h;
      gaps.take(gap, kept >> row & 1u);
    } else if (laws_[at(a)].inverseCompliance != 0) {
      residual[at(row)] = (0.5 * h * meanForce(a, h).force - impulse_[at(k)][at(row)]) / laws_[at(a)].inverseCompliance;
      // As a position: remaining displacement of the soft row and its masses.
      const double inverseCompliance = std::fabs(laws_[at(a)].inverseCompliance) * system_.rowSize(k, row);
      Gaps::takeLarger(gaps.largest, residual[at(row)] * h * inverseCompliance / (1 + inverseCompliance));
    }
  }
}

void RattleStep::applyCorrection(const Part& part, double h) {
  for (const int node : part.bodies) {
    Twist& V = mean_[at(system_.bodyOf(node))];
    V.v += linear(x_[at(node)]);
    V.w += angular(x_[at(node)]);
    x_[at(node)] = {};
    if (relinearised_[at(part.index)]) continue;
    // The momentum after the new impulses is I w + the gyroscopic part of the previous iterate.
    const Mat3d& I = system_.inertia(node);
    if (std::fabs(h) * norm(V.w) * inertiaSpread_[at(node)] > kFreeSpin) {
      V.w = angularVelocityOf(I, I * V.w + gyro_[at(node)], V.w, h);
      gyro_[at(node)] = gyroscopicMomentum(I, V.w, h); // solved: no residual for the next iterate
    }
  }
  for (const int k : part.constraints)
    for (std::size_t r = 0; r < 6; ++r) impulse_[at(k)][r] += x_[at(rowNode(k))][r];
  for (const int c : part.couplings) couplingImpulse_[at(c)] += x_[at(system_.couplingNode(c))][0];
}

/// Spin after the first half kick: the sum of the impulses, so that spin is conserved to round-off; after a
/// relinearisation, computed from the mean twist.
void RattleStep::collectMomentum(const Part& part, const State& state, const Loads& loads, double h) {
  stepLedger_ = {};
  if (relinearised_[at(part.index)]) {
    for (const int node : part.bodies) {
      const int b = system_.bodyOf(node);
      const Mat3d I = rotatedInertia(frames_[at(b)].R, model_.bodies()[at(b)].inertia_B);
      spin_[at(node)] = I * mean_[at(b)].w + gyroscopicMomentum(I, mean_[at(b)].w, h);
    }
    accountFirstKick(part, state, loads, h);
    return;
  }
  for (const int node : part.bodies) {
    const int b = system_.bodyOf(node);
    spin_[at(node)] = state.angularMomentum[at(b)] + 0.5 * h * loads.external[at(b)].torque;
    x_[at(node)] = {};
  }
  for (const int k : part.constraints) {
    for (int r = 0; r < 6; ++r)
      if (const double total = impulse_[at(k)][at(r)]; total != 0) give(k, r, total);
    for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a) {
      const double known = 0.5 * h * (nodeForce(soft_[at(a)], x0_[at(a)]) + soft_[at(a)].applied0);
      if (known != 0) give(k, system_.axes()[at(a)].row, known);
    }
  }
  for (const int c : part.couplings) {
    const CouplingRow& row = system_.couplings()[at(c)];
    const Axis &one = system_.axes()[at(row.axis1)], &two = system_.axes()[at(row.axis2)];
    give(two.constraint, two.row, couplingImpulse_[at(c)]);
    give(one.constraint, one.row, -row.ratio * couplingImpulse_[at(c)]);
  }
  for (const int node : part.bodies) spin_[at(node)] += angular(x_[at(node)]);
  accountFirstKick(part, state, loads, h);
}

} // namespace grouser::multibody::detail
