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

/// Tolerance of rates relative to the fastest twist (round-off). One pass solves the rates; further passes remove
/// errors due to small pivots.
constexpr double kRateRoundOff = 1e-14;
constexpr int kMaxPasses = 4;

} // namespace

/// Solves p_1 = P(u) + h/2 f(q_1) + J^T Mu, J v_1 = rates for v_1 - u and Mu.
void RattleStep::solveVelocities(const Part& part, const Loads& loads, double h) {
  factorEnd(part);
  setSecondKick(part, loads, h);
  double fastest = 0;
  for (const int node : part.bodies) {
    const Twist& V = mean_[at(system_.bodyOf(node))];
    fastest = std::max({fastest, norm(V.v), norm(V.w)});
  }
  setRateResiduals(part);
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    system_.solve(part, x_);
    for (const int node : part.bodies) {
      Twist& V = twist_[at(system_.bodyOf(node))];
      V.v += linear(x_[at(node)]);
      V.w += angular(x_[at(node)]);
      x_[at(node)] = {};
    }
    for (const int k : part.constraints)
      for (std::size_t r = 0; r < 6; ++r) endImpulse_[at(k)][r] += x_[at(rowNode(k))][r];
    for (const int c : part.couplings) couplingEndImpulse_[at(c)] += x_[at(system_.couplingNode(c))][0];
    if (setRateResiduals(part) <= kRateRoundOff * fastest) break;
  }
  addEndImpulses(part);
  bookSecondKick(part, loads, h);
}

/// Matrix at the end of the stage.
void RattleStep::factorEnd(const Part& part) {
  for (const int k : part.constraints)
    for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a) {
      laws_[at(a)] = {};
      laws_[at(a)].driven = soft_[at(a)].driven;
      drivenThen_[at(a)] = soft_[at(a)].driven ? 1 : 0;
    }
  // A row with a tiny pivot near a singular position would slow down the motion through it.
  system_.scalePivotThreshold(firmPivotScale(options_.positionTolerance));
  const int lost = linearise(part, trial_);
  system_.scalePivotThreshold(1);
  // The position solve of the next stage requires every row with a pivot.
  factored_[at(part.index)] = lost == 0 ? system_.linearisation(part) : -1;
}

/// Momentum of the second half kick without the rows' impulses, as residuals of the bodies.
void RattleStep::setSecondKick(const Part& part, const Loads& loads, double h) {
  for (const int node : part.bodies) {
    const int b = system_.bodyOf(node);
    const Wrench& wrench = loads.external[at(b)];
    twist_[at(b)] = mean_[at(b)];
    set(x_[at(node)], 0.5 * h * (wrench.force + model_.bodies()[at(b)].mass * loads.gravity), 0.5 * h * wrench.torque);
  }
  for (const int k : part.constraints) {
    endImpulse_[at(k)] = {};
    for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a) {
      const int row = system_.axes()[at(a)].row;
      // Impulse of the implicit part, the same as in the first half, and of the nodal forces. Excludes a driven row's
      // own impulse.
      const double meanImpulse = soft_[at(a)].driven ? 0.5 * h * meanForce(a, h).force : impulse_[at(k)][at(row)];
      const double known = meanImpulse + 0.5 * h * (nodeForce(soft_[at(a)], x1_[at(a)]) + soft_[at(a)].applied1);
      if (known != 0) give(k, row, known);
    }
  }
  for (const int c : part.couplings) couplingEndImpulse_[at(c)] = 0;
  for (const int node : part.bodies) {
    kick_[at(node)] = x_[at(node)], meanSpin_[at(node)] = spin_[at(node)];
    spin_[at(node)] += angular(x_[at(node)]);
    add(x_[at(node)], {},
        -(angular(x_[at(node)])) + (spin_[at(node)] - system_.inertia(node) * mean_[at(system_.bodyOf(node))].w));
  }
}

/// Adds the row impulses to the angular momenta.
void RattleStep::addEndImpulses(const Part& part) {
  for (const int node : part.bodies) x_[at(node)] = {};
  for (const int k : part.constraints)
    for (int r = 0; r < 6; ++r)
      if (const double total = endImpulse_[at(k)][at(r)]; total != 0) give(k, r, total);
  for (const int c : part.couplings) {
    const CouplingRow& row = system_.couplings()[at(c)];
    const Axis &one = system_.axes()[at(row.axis1)], &two = system_.axes()[at(row.axis2)];
    give(two.constraint, two.row, couplingEndImpulse_[at(c)]);
    give(one.constraint, one.row, -row.ratio * couplingEndImpulse_[at(c)]);
  }
  for (const int node : part.bodies) spin_[at(node)] += angular(x_[at(node)]);
}

/// Writes rate errors into the row residuals; returns the largest of rows with a pivot.
double RattleStep::setRateResiduals(const Part& part) {
  double largest = 0;
  for (const int k : part.constraints) {
    Vector6& residual = x_[at(rowNode(k))];
    residual = {};
    const unsigned hard = hardRows(system_.constraints()[at(k)].kind), kept = system_.elimination().keptRows(k);
    for (int r = 0; r < 6; ++r) {
      if (!(hard >> r & 1u)) continue;
      residual[at(r)] = -system_.rate(k, r, twist_);
      if (kept >> r & 1u) largest = std::max(largest, std::fabs(residual[at(r)]));
    }
    for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a) {
      if (!soft_[at(a)].driven) continue;
      const std::size_t row = at(system_.axes()[at(a)].row);
      residual[row] = soft_[at(a)].rate - system_.rateOfAxis(a, twist_);
      if (kept >> row & 1u) largest = std::max(largest, std::fabs(residual[row]));
    }
  }
  for (const int c : part.couplings) {
    const CouplingRow& row = system_.couplings()[at(c)];
    const double rate = system_.rateOfAxis(row.axis2, twist_) - row.ratio * system_.rateOfAxis(row.axis1, twist_);
    x_[at(system_.couplingNode(c))] = {};
    x_[at(system_.couplingNode(c))][0] = -rate;
    if (system_.couplingKept(c)) largest = std::max(largest, std::fabs(rate));
  }
  return largest;
}

/// Work over the stage, and the new state. Work of gravity, springs and stops: decrease of their energies; of drives
/// and dampers: mean force times path. rattle_ledger.cpp computes the work of loads in the kicks.
void RattleStep::finish(const Part& part, State& state, const Loads& loads, double h) {
  Ledger& ledger = state.ledger;
  for (const int node : part.bodies) {
    const int b = system_.bodyOf(node);
    const Vec3d path = trialPose_[at(b)].position - state.pose[at(b)].position;
    const double fall = model_.bodies()[at(b)].mass * dot(loads.gravity, path);
    ledger.gravityWork += fall;
    stepLedger_.potential -= fall;
    checkTwist(model_.bodies()[at(b)], {twist_[at(b)].v, mean_[at(b)].w}, state.time, h);
    checkTwist(model_.bodies()[at(b)], {twist_[at(b)].v, twist_[at(b)].w}, state.time, 0);
  }
  for (const int k : part.constraints)
    for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a) finishAxis(a, state, h);
  stepLedger_.addTo(ledger);
  for (const int node : part.bodies) {
    const int b = system_.bodyOf(node);
    state.twist[at(b)] = twist_[at(b)];
    state.pose[at(b)] = trialPose_[at(b)];
    state.angularMomentum[at(b)] = spin_[at(node)];
    frames_[at(b)] = trial_[at(b)];
  }
}

/// Work along an axis, and its new position.
void RattleStep::finishAxis(int a, State& state, double h) {
  const int k = system_.axes()[at(a)].constraint;
  const std::size_t row = at(system_.axes()[at(a)].row);
  const SoftRow& s = soft_[at(a)];
  Ledger& ledger = state.ledger;
  const double path = x1_[at(a)] - x0_[at(a)];
  const double loosened = softRows_.energy(s, a, x0_[at(a)]) - softRows_.energy(s, a, x1_[at(a)]);
  ledger.springWork += loosened;
  stepLedger_.elastic -= loosened;
  ledger.dissipated += s.damping * path * path / h;
  stepLedger_.jointDamping += s.jointDamping * path * path / h;
  stepLedger_.springDamping += s.springDamping * path * path / h;
  if (s.stops) {
    const double loss = softRows_.stopLoss(a, x0_[at(a)], x1_[at(a)], h);
    ledger.dissipated += loss;
    stepLedger_.stopDamping += loss;
  }
  ledger.driveWork += 0.5 * (s.applied0 + s.applied1) * path;
  if (s.driven) {
    // Impulse times mean rate in each half; this is also correct if a law starts with an impact.
    const double meanRate = path / h, first = impulse_[at(k)][row] - 0.5 * h * meanForce(a, h).force;
    ledger.driveWork += 0.5 * (first * (startRate_[at(a)] + meanRate) +
                               endImpulse_[at(k)][row] * (meanRate + system_.rateOfAxis(a, twist_)));
  }
  if (isJoint(system_.constraints()[at(k)].kind)) axisPositionIn(state, system_, a) = x1_[at(a)];
}

/// Reactions, and forces of springs and dampers, at the end of the step.
void RattleStep::readReactions(const Part& part, State& state, const Loads& loads) {
  for (const int k : part.constraints)
    for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a) {
      const SoftRow& s = soft_[at(a)];
      axisRate_[at(a)] = system_.rateOfAxis(a, state.twist);
      springForce_[at(a)] = softRows_.springForce(s, a, x1_[at(a)], axisRate_[at(a)]);
      axisForce_[at(a)] = springForce_[at(a)] - s.damping * axisRate_[at(a)] + s.applied1;
    }
  solveReactions(system_, model_, part, frames_, state, loads, soft_, axisForce_, x_);
  for (const int k : part.constraints) readConstraint(k, state);
  for (const int c : part.couplings) state.coupling[at(c)].force = x_[at(system_.couplingNode(c))][0];
}

void RattleStep::readConstraint(int k, State& state) {
  const Constraint& c = system_.constraints()[at(k)];
  const RowDirections& rows = system_.rows(k);
  const Vector6& lambda = x_[at(rowNode(k))];
  std::array<double, 6> total{};
  for (std::size_t r = 0; r < 6; ++r) total[r] = lambda[r];
  const auto springs = [&](int a) { return springForce_[at(a)] - soft_[at(a)].damping * axisRate_[at(a)]; };
  for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a)
    total[at(system_.axes()[at(a)].row)] += springs(a) + soft_[at(a)].applied1;
  Vec3d force, torque;
  for (std::size_t r = 0; r < 6; ++r) {
    force += total[r] * rows.force[r];
    torque += total[r] * rows.torque[r];
  }
  const int first = system_.firstAxis(k);
  if (c.kind == ConstraintKind::kPointSpring) {
    state.spring[at(c.source)] = {total[0], x1_[at(first)]};
    return;
  }
  if (c.kind == ConstraintKind::kBushing) {
    state.bushing[at(c.source)] = {force,
                                   torque,
                                   {x1_[at(first)], x1_[at(first + 1)], x1_[at(first + 2)]},
                                   {x1_[at(first + 3)], x1_[at(first + 4)], x1_[at(first + 5)]}};
    return;
  }
  JointReading& reading = state.joint[at(c.source)];
  reading.force = force;
  reading.torque = torque;
  const auto read = [&](int a, auto& axis) {
    const std::size_t row = at(system_.axes()[at(a)].row);
    axis.position = x1_[at(a)];
    axis.rate = axisRate_[at(a)];
    axis.axisForce = total[row];
    axis.driveForce = (soft_[at(a)].driven ? lambda[row] : 0) + soft_[at(a)].applied1;
    axis.springForce = springs(a) + model_.joints()[at(c.source)].damping * axisRate_[at(a)];
    if (c.kind == ConstraintKind::kCylindrical && static_cast<int>(row) == kSlideRow)
      axis.springForce = springs(a) + model_.joints()[at(c.source)].slideDamping * axisRate_[at(a)];
  };
  for (int a = first; a < system_.firstAxis(k + 1); ++a)
    if (c.kind == ConstraintKind::kCylindrical && system_.axes()[at(a)].row == kSlideRow)
      read(a, state.slide[at(c.source)]);
    else
      read(a, reading);
}

} // namespace grouser::multibody::detail
