// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/euler_step.hpp"

#include "base/error.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/rotation.hpp"
#include "multibody/detail/vector6.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <utility>

/// The scheme. Positions q at the nodes, twists u constant over each step, impulses Lambda at the nodes:
///
///   S(u_new) = S(u_old) + dt f(q) + J(q)^T Lambda        momentum (S: rotation.hpp; mass times velocity for the rest)
///   q_new = q moved by dt u_new                          rotation by exp(dt w)
///   C(q_new) = 0                                         hard rows
///   J(q) u_new + Lambda / (dt c + dt^2 k) = 0            soft rows (the known part of a spring's force is in f)
///   J(q) u_new = rate                                    driven rows
///   x_2(q_new) - ratio x_1(q_new) = offset               couplings
///
/// That is symplectic Euler with the constraint on positions (SHAKE; Hairer, Lubich and Wanner 2006, VII.1.4): no
/// drift, no stabilisation term, and the impulses that close the joints are the constraint forces themselves, so that
/// linear and angular momentum are conserved to round-off and energy has no secular loss. Solved by Newton's method
/// with the matrix of the velocity problem, factored once a step; the correction of an iteration is dt |w| times the
/// one before; near singular positions it is helped as in RATTLE (rattle_step.cpp). Soft and driven rows are linear,
/// are solved once, and are not moved by the corrections.
namespace grouser::multibody::detail {

namespace {

/// Iterations before a slow position solve is helped, and new gap over the one before above which it is slow: Newton's
/// method with the matrix of the start takes a gap down by dt |w|, far below a fifth in a step that is worth taking.
constexpr int kPatience = 4;
constexpr double kSlowConvergence = 0.2;

} // namespace

void EulerStep::setFirstResidual(const ConstraintSystem::Part& part, const State& state, const Loads& loads,
                                 double dt) {
  startLinks(state, loads, dt);
  startLinkAxes(state, dt);
  for (const int k : system.offTree()) {
    impulse[at(k)] = {};
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      const int row = system.axes()[at(a)].row;
      oldRate[at(a)] = system.rate(k, row, state.twist);
      // The known force of a spring acts along its row.
      system.addImpulse(k, row, dt * laws[at(a)].force, x);
    }
  }
  for (const int c : part.couplings) couplingImpulse[at(c)] = 0;
}

/// Gaps of all joints and couplings over -dt. `first`: also what soft and driven axes ask for.
double EulerStep::setGapResidual(const ConstraintSystem::Part& part, const State& state, double dt, bool first) {
  double largest = setLinkGaps(dt, first);
  const double scale = -1 / dt;
  // Written so that a gap that is not a number counts as the largest.
  const auto meet = [&](double gap) {
    if (!(std::fabs(gap) <= largest)) largest = std::fabs(gap);
  };
  for (const int k : system.offTree()) {
    double error[6];
    positionError(system.constraints()[at(k)], trialFramesOf(k), error);
    Vector6& residual = x[at(rowNode(k))];
    const unsigned hard = system.hardRowsOf(k);
    for (int r = 0; r < 6; ++r) {
      const double gap = hard >> r & 1u ? error[r] : 0;
      residual[at(r)] = scale * gap;
      meet(gap);
    }
    if (first)
      for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a)
        residual[at(system.axes()[at(a)].row)] = (laws[at(a)].driven ? laws[at(a)].speed : 0) - oldRate[at(a)];
  }
  for (const int c : part.couplings) {
    const CouplingRow& row = system.couplings()[at(c)];
    const double gap = trialPosition(state, row.axis2) - row.ratio * trialPosition(state, row.axis1) - row.offset;
    x[at(system.couplingNode(c))][0] = scale * gap;
    if (system.couplingKept(c)) meet(gap);
  }
  return largest;
}

JointFrames EulerStep::trialFramesOf(int k) const {
  const Constraint& c = system.constraints()[at(k)];
  return framesOf(c, trial[at(c.bodyA)], trial[at(c.bodyB)]);
}

/// The row with the widest gap at the end of the step as the current iterate has it; no constraint if there are only
/// couplings.
EulerStep::OpenRow EulerStep::widestGap() const {
  OpenRow widest;
  for (std::size_t k = 0; k < system.constraints().size(); ++k) {
    double error[6];
    positionError(system.constraints()[k], trialFramesOf(static_cast<int>(k)), error);
    for (int r = 0; r < 6; ++r)
      if ((system.hardRowsOf(static_cast<int>(k)) >> r & 1u) && !(std::fabs(error[r]) <= widest.gap))
        widest = {static_cast<int>(k), r, std::fabs(error[r])};
  }
  return widest;
}

/// Position of an axis at the end of the step as the current iterate has it.
double EulerStep::trialPosition(const State& state, int axis) const {
  const Axis& a = system.axes()[at(axis)];
  return axisPositionAfter(system.constraints()[at(a.constraint)], system.jointFrames(a.constraint),
                           trialFramesOf(a.constraint), a.row, axisPositionIn(state, system, axis));
}

void EulerStep::applyCorrection(const ConstraintSystem::Part& part, double dt) {
  system.solve(part, x);
  if (mixing.on() && !relinearised) {
    unpackIterate();
    mixing.improve(part, {newTwist, impulse, couplingImpulse}, x);
  }
  correctLinks(dt);
  for (const int k : system.offTree())
    for (std::size_t r = 0; r < 6; ++r) impulse[at(k)][r] += x[at(rowNode(k))][r];
  for (const int c : part.couplings) couplingImpulse[at(c)] += x[at(system.couplingNode(c))][0];
}

/// The solve anew from the old twist, without the rows whose pivot a turn of this size can take through zero. Returns
/// whether there are any; if not, nothing has changed.
bool EulerStep::startWithoutWeakRows(const ConstraintSystem::Part& part, const State& state, const Loads& loads,
                                     double dt) {
  double turn = 0;
  for (const int node : part.bodies) turn = std::max(turn, dt * norm(state.twist[at(system.bodyOf(node))].w));
  system.scalePivotThreshold(weakPivotScale(turn));
  const int weak = system.linearise(part, frames, laws);
  system.scalePivotThreshold(1);
  if (weak == 0) {
    system.linearise(part, frames, laws);
    return false;
  }
  setFirstResidual(part, state, loads, dt);
  moveLinks(dt);
  setGapResidual(part, state, dt, true);
  mixing.reset();
  return true;
}

void EulerStep::solvePart(const ConstraintSystem::Part& part, State& state, const Loads& loads, double dt) {
  PositionSolve solve;
  solve.lost = system.linearise(part, frames, laws);
  last.singularRows += solve.lost;

  // First solve from the old twist: the gap it would open already holds the curvature of the constraints.
  setFirstResidual(part, state, loads, dt);
  moveLinks(dt);
  setGapResidual(part, state, dt, true);

  mixing.reset();
  relinearised = false;
  for (bool solved = false; !solved;) {
    iterate(part, state, dt, solve);
    solved = advance(part, state, loads, dt, solve);
    if (!solved && solve.phase == Phase::kEachIterate) relinearise(part, state, dt, solve);
  }
  last.iterations = std::max(last.iterations, solve.iterations);
  last.maxPositionError = std::max(last.maxPositionError, solve.gap);
  finish(part, state, loads, dt);
}

/// One iteration of Newton's method, and how it went.
void EulerStep::iterate(const ConstraintSystem::Part& part, const State& state, double dt, PositionSolve& solve) {
  applyCorrection(part, dt);
  moveLinks(dt);
  ++solve.iterations, ++solve.since;
  solve.gap = setGapResidual(part, state, dt, false);
  const double turn = relinearised ? 0 : setLinkGyro(dt);
  solve.done = solve.gap <= options.positionTolerance && turn <= options.positionTolerance;
  solve.slow = !(solve.gap <= kSlowConvergence * solve.before);
  solve.before = solve.gap;
}

/// What to do after an iteration: returns whether the positions are found, or enters the next phase.
bool EulerStep::advance(const ConstraintSystem::Part& part, const State& state, const Loads& loads, double dt,
                        PositionSolve& solve) {
  switch (solve.phase) {
  case Phase::kAllRows:
    return advanceAllRows(part, state, loads, dt, solve);
  case Phase::kWithoutWeakRows:
    advanceWithoutWeakRows(part, state, dt, solve);
    return false;
  case Phase::kMixed:
    if (solve.done && openGap() <= kGapFailure) return true;
    if (solve.done || solve.since >= 2 * options.maxIterations || !std::isfinite(solve.gap))
      solve.enter(Phase::kEachIterate);
    return false;
  case Phase::kEachIterate:
    break;
  }
  const bool exhausted = solve.since >= 3 * options.maxIterations;
  if (!solve.done && exhausted && !(solve.gap <= kGapFailure)) fail(state, solve.gap, solve.iterations, dt);
  return solve.done || exhausted;
}

/// All rows, with the matrix of the start of the step: all that nearly every step needs.
bool EulerStep::advanceAllRows(const ConstraintSystem::Part& part, const State& state, const Loads& loads, double dt,
                               PositionSolve& solve) {
  if (solve.done && (solve.lost == 0 || openGap() <= kGapFailure)) return true;
  if (solve.since >= kPatience) {
    unpackIterate();
    mixing.remember(part, solve.gap, newTwist);
  }
  // Slow: a singular position is near, or the bodies turn far in a step.
  if (solve.since == kPatience && solve.slow) {
    if (startWithoutWeakRows(part, state, loads, dt))
      solve.enter(Phase::kWithoutWeakRows);
    else
      mixing.switchOn();
  } else if (solve.since >= (mixing.on() ? 3 : 1) * options.maxIterations) {
    solve.enter(Phase::kEachIterate);
  }
  return false;
}

/// Without the weak rows until that has led to where inertia takes the bodies; from there the others have a short way
/// to go, and to the solution that inertia leads to.
void EulerStep::advanceWithoutWeakRows(const ConstraintSystem::Part& part, const State& state, double dt,
                                       PositionSolve& solve) {
  if (!solve.done && solve.since < options.maxIterations && !(solve.since > 2 && solve.slow)) return;
  unpackIterate();
  mixing.remember(part, solve.gap, newTwist);
  system.scalePivotThreshold(firmPivotScale(options.positionTolerance));
  system.linearise(part, frames, laws);
  system.scalePivotThreshold(1);
  setGapResidual(part, state, dt, false);
  mixing.switchOn();
  solve.enter(Phase::kMixed);
}

/// Takes the matrix of the iterate, first of the best one so far.
void EulerStep::relinearise(const ConstraintSystem::Part& part, const State& state, double dt,
                            const PositionSolve& solve) {
  if (solve.since == 0 && std::isfinite(mixing.bestGap())) {
    mixing.takeBest(part, newTwist);
    packTwists();
    moveLinks(dt);
  }
  relinearised = true;
  system.linearise(part, trial, laws);
  for (const int node : part.bodies) x[at(node)] = {};
  setGapResidual(part, state, dt, false);
}

void EulerStep::fail(const State& state, double gap, int iterations, double dt) const {
  const OpenRow widest = widestGap();
  std::ostringstream message;
  message << "multibody step from t = " << state.time << " s";
  if (widest.constraint >= 0)
    message << ": " << system.describe(widest.constraint, widest.row) << " stays open by " << widest.gap
            << " [m or rad]";
  message << " (largest residual " << gap << ") after " << iterations
          << " iterations; the motion is too fast for dt = " << dt << " s: reduce the step, or check the loads";
  throw base::SimulationError(message.str());
}

/// Of all rows that should hold, those without a pivot too.
double EulerStep::openGap() const {
  double largest = 0;
  for (std::size_t k = 0; k < system.constraints().size(); ++k) {
    double error[6];
    positionError(system.constraints()[k], trialFramesOf(static_cast<int>(k)), error);
    for (int r = 0; r < 6; ++r)
      if ((hardRows(system.constraints()[k].kind) >> r & 1u) && !(std::fabs(error[r]) <= largest))
        largest = std::fabs(error[r]);
  }
  return largest;
}

/// Work, momenta, readings and poses of one part once its impulses are known.
void EulerStep::finish(const ConstraintSystem::Part& part, State& state, const Loads& loads, double dt) {
  finishLinks(state, loads, dt);
  for (const int c : part.couplings) {
    const CouplingRow& row = system.couplings()[at(c)];
    for (const auto& [axis, share] : {std::pair{row.axis2, 1.0}, std::pair{row.axis1, -row.ratio}}) {
      const Axis& a = system.axes()[at(axis)];
      addAngularMomentum(a.constraint, share * couplingImpulse[at(c)] * system.rows(a.constraint).force[at(a.row)],
                         share * couplingImpulse[at(c)] * system.rows(a.constraint).torque[at(a.row)], state);
    }
    state.coupling[at(c)].force = couplingImpulse[at(c)] / dt;
  }
  for (const int k : system.offTree()) readConstraint(k, state, dt);
  if (relinearised)
    for (const int node : part.bodies) {
      // The impulses belong to rows of several positions: the momentum is what the twist says.
      const std::size_t b = at(system.bodyOf(node));
      const Mat3d I = rotatedInertia(frames[b].R, model.bodies()[b].inertia_B);
      state.angularMomentum[b] = I * state.twist[b].w + gyroscopicMomentum(I, state.twist[b].w, dt);
    }
}

void EulerStep::addAngularMomentum(int k, const Vec3d& force, const Vec3d& torque, State& state) const {
  const Constraint& c = system.constraints()[at(k)];
  const Vec3d& p = system.jointFrames(k).p_B;
  if (c.nodeB >= 0) state.angularMomentum[at(c.bodyB)] += cross(p - frames[at(c.bodyB)].p, force) + torque;
  if (c.nodeA >= 0) state.angularMomentum[at(c.bodyA)] -= cross(p - frames[at(c.bodyA)].p, force) + torque;
}

/// Adds what is known along the axes of one constraint to the impulses of its rows, and their work.
void EulerStep::addAxes(int k, std::array<double, 6>& total, State& state, double dt) {
  for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
    const std::size_t row = at(system.axes()[at(a)].row);
    const AxisLaw& law = laws[at(a)];
    const double newRate = system.rate(k, static_cast<int>(row), state.twist);
    total[row] += dt * law.force;
    const double path = 0.5 * dt * (oldRate[at(a)] + newRate);
    const AxisWork work = axisLaws.work(law, impulse[at(k)][row] / dt, newRate, path, dt);
    state.ledger.driveWork += work.drive;
    state.ledger.springWork += work.spring;
    state.ledger.dissipated += work.dissipated;
    newRates[at(a)] = newRate;
  }
}

void EulerStep::readConstraint(int k, State& state, double dt) {
  const Constraint& c = system.constraints()[at(k)];
  const RowDirections& rows = system.rows(k);
  const JointFrames after = trialFramesOf(k);
  std::array<double, 6> total = impulse[at(k)];
  addAxes(k, total, state, dt);

  Vec3d force, torque;
  for (std::size_t r = 0; r < 6; ++r) {
    force += total[r] * rows.force[r];
    torque += total[r] * rows.torque[r];
  }
  addAngularMomentum(k, force, torque, state);

  if (c.kind == ConstraintKind::kPointSpring) {
    state.spring[at(c.source)] = {total[0] / dt, axisPosition(c, after, 0)};
    return;
  }
  if (c.kind == ConstraintKind::kBushing) {
    const auto position = [&](int row) { return axisPosition(c, after, row); };
    state.bushing[at(c.source)] = {
        force * (1 / dt), torque * (1 / dt), {position(0), position(1), position(2)}, relativeRotation(after)};
    return;
  }
  JointReading& reading = state.joint[at(c.source)];
  reading.force = force * (1 / dt);
  reading.torque = torque * (1 / dt);
  readAxes(k, total, state, dt);
}

/// What the axes of a joint did, `total` being the impulses of its rows.
void EulerStep::readAxes(int k, const std::array<double, 6>& total, State& state, double dt) const {
  const Constraint& c = system.constraints()[at(k)];
  const auto read = [&](int a, auto& axis) {
    const std::size_t row = at(system.axes()[at(a)].row);
    const AxisLaw& law = laws[at(a)];
    axis.position = trialPosition(state, a);
    axis.rate = newRates[at(a)];
    axis.axisForce = total[row] / dt;
    axis.driveForce = law.driven ? impulse[at(k)][row] / dt : 0;
    if (law.driveForce != 0) axis.driveForce += law.driveForce;
    axis.springForce = law.springKnown - law.springInverseCompliance / dt * newRates[at(a)];
  };
  for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a)
    if (c.kind == ConstraintKind::kCylindrical && system.axes()[at(a)].row == kSlideRow)
      read(a, state.slide[at(c.source)]);
    else
      read(a, state.joint[at(c.source)]);
}

EulerStep::EulerStep(const Problem& problem)
    : model(problem.model), options(problem.options), system(problem.system), driveStart(problem.driveStart),
      last(problem.last), axisLaws(model), laws(system.axes().size()), x(at(system.nodes())),
      steps(system.links().size()), impulse(system.constraints().size()), couplingImpulse(system.couplings().size()),
      oldRate(system.axes().size(), 0.0), newRates(system.axes().size(), 0.0), mixing(system, model),
      newTwist(model.bodies().size()) {
  std::vector<Pose> poses;
  for (const Body& body : model.bodies()) poses.push_back(body.pose);
  system.place(poses, frames);
  trial = frames;
  for (std::size_t i = 0; i < steps.size(); ++i)
    for (std::size_t l = 0; l < kLanes; ++l)
      steps[i].spread[l] = spreadOf(model.bodies()[at(system.links()[i].body[l])].inertia_B);
}

void EulerStep::step(State& state, const Loads& loads, double dt) {
  system.place(state.pose, frames);
  axisLaws.evaluate(system, state, loads, dt, frames, driveStart, laws);
  for (const ConstraintSystem::Part& part : system.parts()) solvePart(part, state, loads, dt);
  state.time += dt;
}

} // namespace grouser::multibody::detail
