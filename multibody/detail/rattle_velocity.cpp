// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/rattle_step.hpp"

#include "multibody/detail/axis_laws.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/reactions.hpp"
#include "multibody/detail/rotation.hpp"
#include "multibody/detail/vector6.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

/// Second half of a stage of RATTLE (rattle_step.cpp), and the reactions at its end.
namespace grouser::multibody::detail {

namespace {

/// Part of the fastest twist that rates may miss: round-off. One pass solves them; more take out what small pivots
/// leave.
constexpr double kRateRoundOff = 1e-14;
constexpr int kMostPasses = 4;

} // namespace

/// p_1 = P(u) + h/2 f(q_1) + J^T Mu, J v_1 = rates, solved for v_1 - u and Mu.
void RattleStep::solveVelocities(const Part& part, const Loads& loads, double h) {
  factorEnd(part);
  setSecondKick(part, loads, h);
  double fastest = 0;
  for (const int node : part.bodies) {
    const Twist& V = mean[at(system.bodyOf(node))];
    fastest = std::max({fastest, norm(V.v), norm(V.w)});
  }
  setRateResiduals(part);
  for (int pass = 0; pass < kMostPasses; ++pass) {
    system.solve(part, x);
    for (const int node : part.bodies) {
      Twist& V = twist[at(system.bodyOf(node))];
      V.v += linear(x[at(node)]);
      V.w += angular(x[at(node)]);
      x[at(node)] = {};
    }
    for (const int k : part.constraints)
      for (std::size_t r = 0; r < 6; ++r) endImpulse[at(k)][r] += x[at(rowNode(k))][r];
    for (const int c : part.couplings) couplingEndImpulse[at(c)] += x[at(system.couplingNode(c))][0];
    if (setRateResiduals(part) <= kRateRoundOff * fastest) break;
  }
  addEndImpulses(part);
}

/// The matrix at the end of the stage.
void RattleStep::factorEnd(const Part& part) {
  for (const int k : part.constraints)
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      laws[at(a)] = {};
      laws[at(a)].driven = soft[at(a)].driven;
      drivenThen[at(a)] = soft[at(a)].driven;
    }
  // A row that a singular position leaves hardly a pivot would take speed out of the motion through it.
  system.scalePivotThreshold(firmPivotScale(options.positionTolerance));
  const int lost = linearise(part, trial);
  system.scalePivotThreshold(1);
  // The next stage's positions need every row that has a pivot at all.
  factored[at(part.index)] = lost == 0 ? system.linearisation(part) : -1;
}

/// Momentum of the second half kick without the rows' impulses, as residuals of the bodies.
void RattleStep::setSecondKick(const Part& part, const Loads& loads, double h) {
  for (const int node : part.bodies) {
    const int b = system.bodyOf(node);
    const Wrench& wrench = loads.external[at(b)];
    twist[at(b)] = mean[at(b)];
    set(x[at(node)], 0.5 * h * (wrench.force + model.bodies()[at(b)].mass * loads.gravity), 0.5 * h * wrench.torque);
  }
  for (const int k : part.constraints) {
    endImpulse[at(k)] = {};
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      const int row = system.axes()[at(a)].row;
      // The implicit part's impulse, the same as in the first half, and what acts at the node. A driven row's own
      // impulse is not among them.
      const double meanImpulse = soft[at(a)].driven ? 0.5 * h * meanForce(a, h).force : impulse[at(k)][at(row)];
      const double known = meanImpulse + 0.5 * h * (nodeForce(soft[at(a)], x1[at(a)]) + soft[at(a)].applied1);
      if (known != 0) system.addImpulse(k, row, known, x);
    }
  }
  for (const int c : part.couplings) couplingEndImpulse[at(c)] = 0;
  for (const int node : part.bodies) {
    spin[at(node)] += angular(x[at(node)]);
    add(x[at(node)], {},
        -(angular(x[at(node)])) + (spin[at(node)] - system.inertia(node) * mean[at(system.bodyOf(node))].w));
  }
}

/// What the rows' impulses give to the angular momenta.
void RattleStep::addEndImpulses(const Part& part) {
  for (const int node : part.bodies) x[at(node)] = {};
  for (const int k : part.constraints)
    for (int r = 0; r < 6; ++r)
      if (const double total = endImpulse[at(k)][at(r)]; total != 0) system.addImpulse(k, r, total, x);
  for (const int c : part.couplings) {
    const CouplingRow& row = system.couplings()[at(c)];
    const Axis &one = system.axes()[at(row.axis1)], &two = system.axes()[at(row.axis2)];
    system.addImpulse(two.constraint, two.row, couplingEndImpulse[at(c)], x);
    system.addImpulse(one.constraint, one.row, -row.ratio * couplingEndImpulse[at(c)], x);
  }
  for (const int node : part.bodies) spin[at(node)] += angular(x[at(node)]);
}

/// What the rates miss, into the rows' residuals; returns the largest of the rows that have a pivot.
double RattleStep::setRateResiduals(const Part& part) {
  double largest = 0;
  for (const int k : part.constraints) {
    Vector6& residual = x[at(rowNode(k))];
    residual = {};
    const unsigned hard = hardRows(system.constraints()[at(k)].kind), kept = system.elimination().keptRows(k);
    for (int r = 0; r < 6; ++r) {
      if (!(hard >> r & 1u)) continue;
      residual[at(r)] = -system.rate(k, r, twist);
      if (kept >> r & 1u) largest = std::max(largest, std::fabs(residual[at(r)]));
    }
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      if (!soft[at(a)].driven) continue;
      const std::size_t row = at(system.axes()[at(a)].row);
      residual[row] = soft[at(a)].rate - system.rateOfAxis(a, twist);
      if (kept >> row & 1u) largest = std::max(largest, std::fabs(residual[row]));
    }
  }
  for (const int c : part.couplings) {
    const CouplingRow& row = system.couplings()[at(c)];
    const double rate = system.rateOfAxis(row.axis2, twist) - row.ratio * system.rateOfAxis(row.axis1, twist);
    x[at(system.couplingNode(c))] = {};
    x[at(system.couplingNode(c))][0] = -rate;
    if (system.couplingKept(c)) largest = std::max(largest, std::fabs(rate));
  }
  return largest;
}

/// Work over the stage, and the new state. Gravity, springs and stops: the loss of their energies; loads and drives:
/// mean force times path; dampers: their mean force times path.
void RattleStep::finish(const Part& part, State& state, const Loads& loads, double h) {
  for (const int node : part.bodies) {
    const int b = system.bodyOf(node);
    const Wrench& wrench = loads.external[at(b)];
    const Vec3d path = trialPose[at(b)].position - state.pose[at(b)].position;
    state.ledger.gravityWork += model.bodies()[at(b)].mass * dot(loads.gravity, path);
    state.ledger.externalWork += dot(wrench.force, path) + dot(wrench.torque, h * mean[at(b)].w);
    checkTwist(model.bodies()[at(b)], {twist[at(b)].v, mean[at(b)].w}, state.time, h);
    checkTwist(model.bodies()[at(b)], {twist[at(b)].v, twist[at(b)].w}, state.time, 0);
  }
  for (const int k : part.constraints) {
    const Constraint& c = system.constraints()[at(k)];
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      const SoftRow& s = soft[at(a)];
      const std::size_t row = at(system.axes()[at(a)].row);
      const double path = x1[at(a)] - x0[at(a)];
      state.ledger.springWork += softRows.energy(s, a, x0[at(a)]) - softRows.energy(s, a, x1[at(a)]);
      state.ledger.dissipated += s.damping * path * path / h;
      if (s.stops) state.ledger.dissipated += softRows.stopLoss(a, x0[at(a)], x1[at(a)], h);
      state.ledger.driveWork += 0.5 * (s.applied0 + s.applied1) * path;
      if (s.driven) {
        // Impulse times mean rate in either half: right also when a law starts with an impact.
        const double meanRate = path / h, first = impulse[at(k)][row] - 0.5 * h * meanForce(a, h).force;
        state.ledger.driveWork += 0.5 * (first * (startRate[at(a)] + meanRate) +
                                         endImpulse[at(k)][row] * (meanRate + system.rateOfAxis(a, twist)));
      }
      if (isJoint(c.kind)) axisPositionIn(state, system, a) = x1[at(a)];
    }
  }
  for (const int node : part.bodies) {
    const int b = system.bodyOf(node);
    state.twist[at(b)] = twist[at(b)];
    state.pose[at(b)] = trialPose[at(b)];
    state.angularMomentum[at(b)] = spin[at(node)];
    frames[at(b)] = trial[at(b)];
  }
}

/// Reactions at the end of the step, and what springs and dampers do there.
void RattleStep::readReactions(const Part& part, State& state, const Loads& loads) {
  for (const int k : part.constraints)
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      const SoftRow& s = soft[at(a)];
      axisRate[at(a)] = system.rateOfAxis(a, state.twist);
      springForce[at(a)] = softRows.springForce(s, a, x1[at(a)], axisRate[at(a)]);
      axisForce[at(a)] = springForce[at(a)] - s.damping * axisRate[at(a)] + s.applied1;
    }
  solveReactions(system, model, part, frames, state, loads, soft, axisForce, x);
  for (const int k : part.constraints) readConstraint(k, state);
  for (const int c : part.couplings) state.coupling[at(c)].force = x[at(system.couplingNode(c))][0];
}

void RattleStep::readConstraint(int k, State& state) {
  const Constraint& c = system.constraints()[at(k)];
  const RowDirections& rows = system.rows(k);
  const Vector6& lambda = x[at(rowNode(k))];
  std::array<double, 6> total{};
  for (std::size_t r = 0; r < 6; ++r) total[r] = lambda[r];
  const auto springs = [&](int a) { return springForce[at(a)] - soft[at(a)].damping * axisRate[at(a)]; };
  for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a)
    total[at(system.axes()[at(a)].row)] += springs(a) + soft[at(a)].applied1;
  Vec3d force, torque;
  for (std::size_t r = 0; r < 6; ++r) {
    force += total[r] * rows.force[r];
    torque += total[r] * rows.torque[r];
  }
  const int first = system.firstAxis(k);
  if (c.kind == ConstraintKind::kPointSpring) {
    state.spring[at(c.source)] = {total[0], x1[at(first)]};
    return;
  }
  if (c.kind == ConstraintKind::kBushing) {
    state.bushing[at(c.source)] = {force,
                                   torque,
                                   {x1[at(first)], x1[at(first + 1)], x1[at(first + 2)]},
                                   {x1[at(first + 3)], x1[at(first + 4)], x1[at(first + 5)]}};
    return;
  }
  JointReading& reading = state.joint[at(c.source)];
  reading.force = force;
  reading.torque = torque;
  const auto read = [&](int a, auto& axis) {
    const std::size_t row = at(system.axes()[at(a)].row);
    axis.position = x1[at(a)];
    axis.rate = axisRate[at(a)];
    axis.axisForce = total[row];
    axis.driveForce = (soft[at(a)].driven ? lambda[row] : 0) + soft[at(a)].applied1;
    axis.springForce = springs(a) + model.joints()[at(c.source)].damping * axisRate[at(a)];
    if (c.kind == ConstraintKind::kCylindrical && static_cast<int>(row) == kSlideRow)
      axis.springForce = springs(a) + model.joints()[at(c.source)].slideDamping * axisRate[at(a)];
  };
  for (int a = first; a < system.firstAxis(k + 1); ++a)
    if (c.kind == ConstraintKind::kCylindrical && system.axes()[at(a)].row == kSlideRow)
      read(a, state.slide[at(c.source)]);
    else
      read(a, reading);
}

} // namespace grouser::multibody::detail
