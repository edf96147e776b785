// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/euler_step.hpp"

#include "base/error.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/rotation.hpp"
#include "multibody/detail/vector6.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
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
/// This is symplectic Euler with constraints on positions (SHAKE; Hairer, Lubich and Wanner 2006, VII.1.4): no drift,
/// no stabilisation term. The impulses that close the joints are the constraint forces, so that linear and angular
/// momentum are conserved to round-off and energy has no secular loss. The equations are solved by Newton's method with
/// the matrix of the velocity problem, factored once per step; each correction is about dt |w| times the previous one.
/// Near singular positions, the same methods as in RATTLE (rattle_step.cpp) improve convergence. Soft and driven rows
/// are linear and solved once; corrections do not change them.
namespace grouser::multibody::detail {

namespace {

/// Iterations before a slow position solve changes phase, and gap ratio above which it is slow. With the matrix of the
/// start of the step, Newton's method reduces a gap by a factor dt |w|, far below a fifth in a reasonable step.
constexpr int kPatience = 4;
constexpr double kSlowConvergence = 0.2;

} // namespace

void EulerStep::setFirstResidual(const ConstraintSystem::Part& part, const State& state, const Loads& loads,
                                 double dt) {
  startLinks(state, loads, dt);
  firstSolve_ = true;
  startLinkAxes(state, dt);
  for (const int k : system_.offTree()) {
    impulse_[at(k)] = {};
    for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a) {
      const int row = system_.axes()[at(a)].row;
      oldRate_[at(a)] = system_.rate(k, row, state.twist);
      // The known force of a spring acts along its row.
      system_.addImpulse(k, row, dt * laws_[at(a)].force, x_);
    }
  }
  for (const int c : part.couplings) couplingImpulse_[at(c)] = 0;
  noteOldMotion(part, state);
}

/// Gaps of all joints and couplings, divided by -dt. `first`: also residuals of soft and driven axes.
double EulerStep::setGapResidual(const ConstraintSystem::Part& part, const State& state, double dt, bool first) {
  double largest = setLinkGaps(dt, first);
  const double scale = -1 / dt;
  // With this comparison, NaN counts as the largest gap.
  const auto meet = [&](double gap) {
    if (!(std::fabs(gap) <= largest)) largest = std::fabs(gap);
  };
  for (const int k : system_.offTree()) {
    double error[6];
    positionError(system_.constraints()[at(k)], trialFramesOf(k), error);
    Vector6& residual = x_[at(rowNode(k))];
    const unsigned hard = system_.hardRowsOf(k);
    for (int r = 0; r < 6; ++r) {
      const double gap = hard >> r & 1u ? error[r] : 0;
      residual[at(r)] = scale * gap;
      meet(gap);
    }
    if (first)
      for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a)
        residual[at(system_.axes()[at(a)].row)] = (laws_[at(a)].driven ? laws_[at(a)].speed : 0) - oldRate_[at(a)];
  }
  for (const int c : part.couplings) {
    const CouplingRow& row = system_.couplings()[at(c)];
    const double gap = trialPosition(state, row.axis2) - row.ratio * trialPosition(state, row.axis1) - row.offset;
    x_[at(system_.couplingNode(c))][0] = scale * gap;
    if (system_.couplingKept(c)) meet(gap);
  }
  return largest;
}

JointFrames EulerStep::trialFramesOf(int k) const {
  const Constraint& c = system_.constraints()[at(k)];
  return framesOf(c, trial_[at(c.bodyA)], trial_[at(c.bodyB)]);
}

/// Row with the largest gap at the end of the step for the current iterate; no constraint if the model has only
/// couplings.
EulerStep::OpenRow EulerStep::widestGap() const {
  OpenRow widest;
  for (std::size_t k = 0; k < system_.constraints().size(); ++k) {
    double error[6];
    positionError(system_.constraints()[k], trialFramesOf(static_cast<int>(k)), error);
    for (int r = 0; r < 6; ++r)
      if ((system_.hardRowsOf(static_cast<int>(k)) >> r & 1u) && !(std::fabs(error[r]) <= widest.gap))
        widest = {static_cast<int>(k), r, std::fabs(error[r])};
  }
  return widest;
}

/// Position of an axis at the end of the step for the current iterate.
double EulerStep::trialPosition(const State& state, int axis) const {
  const Axis& a = system_.axes()[at(axis)];
  return axisPositionAfter(system_.constraints()[at(a.constraint)], system_.jointFrames(a.constraint),
                           trialFramesOf(a.constraint), a.row, axisPositionIn(state, system_, axis));
}

void EulerStep::applyCorrection(const ConstraintSystem::Part& part, double dt) {
  if (!firstSolve_) takeGyroResiduals();
  firstSolve_ = false;
  system_.solve(part, x_);
  if (mixing_.on() && !relinearised_) {
    unpackIterate();
    mixing_.improve(part, {newTwist_, impulse_, couplingImpulse_}, x_);
  }
  correctLinks(dt);
  for (const int k : system_.offTree())
    for (std::size_t r = 0; r < 6; ++r) impulse_[at(k)][r] += x_[at(rowNode(k))][r];
  for (const int c : part.couplings) couplingImpulse_[at(c)] += x_[at(system_.couplingNode(c))][0];
}

/// Restarts the solve from the old twist, without rows with pivots that may pass through zero in such a rotation.
/// Returns false, without changes, if there are no such rows.
bool EulerStep::startWithoutWeakRows(const ConstraintSystem::Part& part, const State& state, const Loads& loads,
                                     double dt) {
  double turn = 0;
  for (const int node : part.bodies) turn = std::max(turn, dt * norm(state.twist[at(system_.bodyOf(node))].w));
  system_.scalePivotThreshold(weakPivotScale(turn));
  const int weak = system_.linearise(part, frames_, laws_);
  system_.scalePivotThreshold(1);
  if (weak == 0) {
    system_.linearise(part, frames_, laws_);
    return false;
  }
  setFirstResidual(part, state, loads, dt);
  moveLinks(dt);
  setGapResidual(part, state, dt, true);
  mixing_.reset();
  return true;
}

void EulerStep::solvePart(const ConstraintSystem::Part& part, State& state, const Loads& loads, double dt) {
  PositionSolve solve;
  solve.lost = system_.linearise(part, frames_, laws_);
  last_.singularRows += solve.lost;

  // First solve, from the old twist; the gap for this twist already contains the curvature of the constraints.
  setFirstResidual(part, state, loads, dt);
  moveLinks(dt);
  setGapResidual(part, state, dt, true);

  mixing_.reset();
  relinearised_ = false;
  for (bool solved = false; !solved;) {
    iterate(part, state, dt, solve);
    solved = advance(part, state, loads, dt, solve);
    if (!solved && solve.phase == Phase::kEachIterate) relinearise(part, state, dt, solve);
  }
  last_.iterations = std::max(last_.iterations, solve.iterations);
  last_.maxPositionError = std::max(last_.maxPositionError, solve.gap);
  finish(part, state, loads, dt);
}

/// One Newton iteration and its convergence.
void EulerStep::iterate(const ConstraintSystem::Part& part, const State& state, double dt, PositionSolve& solve) {
  applyCorrection(part, dt);
  moveLinks(dt);
  ++solve.iterations, ++solve.since;
  solve.gap = setGapResidual(part, state, dt, false);
  const double turn = relinearised_ ? 0 : setLinkGyro(dt);
  solve.done = solve.gap <= options_.positionTolerance && turn <= options_.positionTolerance;
  solve.slow = !(solve.gap <= kSlowConvergence * solve.before);
  solve.before = solve.gap;
}

/// Evaluates an iteration: returns true if converged, or enters the next phase.
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
    if (solve.done || solve.since >= 2 * options_.maxIterations || !std::isfinite(solve.gap))
      solve.enter(Phase::kEachIterate);
    return false;
  case Phase::kEachIterate:
    break;
  }
  const bool exhausted = solve.since >= 3 * options_.maxIterations;
  if (!solve.done && exhausted && !(solve.gap <= kGapFailure)) fail(state, solve.gap, solve.iterations, dt);
  return solve.done || exhausted;
}

/// Iterates with all rows and the matrix of the start of the step; sufficient for nearly every step.
bool EulerStep::advanceAllRows(const ConstraintSystem::Part& part, const State& state, const Loads& loads, double dt,
                               PositionSolve& solve) {
  if (solve.done && (solve.lost == 0 || openGap() <= kGapFailure)) return true;
  if (solve.since >= kPatience) {
    unpackIterate();
    mixing_.remember(part, solve.gap, newTwist_);
  }
  // Convergence is slow near a singular position, or if bodies rotate far in a step.
  if (solve.since == kPatience && solve.slow) {
    if (startWithoutWeakRows(part, state, loads, dt))
      solve.enter(Phase::kWithoutWeakRows);
    else
      mixing_.switchOn();
  } else if (solve.since >= (mixing_.on() ? 3 : 1) * options_.maxIterations) {
    solve.enter(Phase::kEachIterate);
  }
  return false;
}

/// Iterates without the weak rows to the inertial motion; from this iterate all rows converge quickly, to the solution
/// consistent with inertia.
void EulerStep::advanceWithoutWeakRows(const ConstraintSystem::Part& part, const State& state, double dt,
                                       PositionSolve& solve) {
  if (!solve.done && solve.since < options_.maxIterations && !(solve.since > 2 && solve.slow)) return;
  unpackIterate();
  mixing_.remember(part, solve.gap, newTwist_);
  system_.scalePivotThreshold(firmPivotScale(options_.positionTolerance));
  system_.linearise(part, frames_, laws_);
  system_.scalePivotThreshold(1);
  setGapResidual(part, state, dt, false);
  mixing_.switchOn();
  solve.enter(Phase::kMixed);
}

/// Relinearises at the current iterate; the first time, at the best iterate so far.
void EulerStep::relinearise(const ConstraintSystem::Part& part, const State& state, double dt,
                            const PositionSolve& solve) {
  if (solve.since == 0 && std::isfinite(mixing_.bestGap())) {
    mixing_.takeBest(part, newTwist_);
    packTwists();
    moveLinks(dt);
  }
  relinearised_ = true;
  system_.linearise(part, trial_, laws_);
  for (const int node : part.bodies) x_[at(node)] = {};
  setGapResidual(part, state, dt, false);
}

void EulerStep::fail(const State& state, double gap, int iterations, double dt) const {
  const OpenRow widest = widestGap();
  std::ostringstream message;
  message << "multibody step from t = " << state.time << " s";
  if (widest.constraint >= 0)
    message << ": " << system_.describe(widest.constraint, widest.row) << " remains open by " << widest.gap
            << " [m or rad]";
  message << " (largest residual " << gap << ") after " << iterations
          << " iterations; the motion is too fast for dt = " << dt << " s: reduce the step, or check the loads";
  throw base::SimulationError(message.str(), base::Cause::fastMotion);
}

/// Largest gap of all hard rows, including rows without a pivot.
double EulerStep::openGap() const {
  double largest = 0;
  for (std::size_t k = 0; k < system_.constraints().size(); ++k) {
    double error[6];
    positionError(system_.constraints()[k], trialFramesOf(static_cast<int>(k)), error);
    for (int r = 0; r < 6; ++r)
      if ((hardRows(system_.constraints()[k].kind) >> r & 1u) && !(std::fabs(error[r]) <= largest))
        largest = std::fabs(error[r]);
  }
  return largest;
}

/// Work, momenta, readings and poses of one part once its impulses are known.
void EulerStep::finish(const ConstraintSystem::Part& part, State& state, const Loads& loads, double dt) {
  finishLinks(state, loads, dt);
  for (const int c : part.couplings) {
    const CouplingRow& row = system_.couplings()[at(c)];
    for (const auto& [axis, share] : {std::pair{row.axis2, 1.0}, std::pair{row.axis1, -row.ratio}}) {
      const Axis& a = system_.axes()[at(axis)];
      addAngularMomentum(a.constraint, share * couplingImpulse_[at(c)] * system_.rows(a.constraint).force[at(a.row)],
                         share * couplingImpulse_[at(c)] * system_.rows(a.constraint).torque[at(a.row)], state);
    }
    state.coupling[at(c)].force = couplingImpulse_[at(c)] / dt;
    recordCoupling(c, state);
  }
  for (const int k : system_.offTree()) readConstraint(k, state, dt);
  if (relinearised_) {
    for (const int node : part.bodies) {
      // The impulses act along rows of several positions: compute the momentum from the twist.
      const std::size_t b = at(system_.bodyOf(node));
      const Mat3d I = rotatedInertia(frames_[b].R, model_.bodies()[b].inertia_B);
      state.angularMomentum[b] = I * state.twist[b].w + gyroscopicMomentum(I, state.twist[b].w, dt);
    }
    bookSeveralPlaces(state);
  } else if (mixing_.on()) {
    recordMixedSpins(state);
  }
  stepLedger_.addTo(state.ledger);
}

void EulerStep::addAngularMomentum(int k, const Vec3d& force, const Vec3d& torque, State& state) const {
  const Constraint& c = system_.constraints()[at(k)];
  const Vec3d& p = system_.jointFrames(k).p_B;
  if (c.nodeB >= 0) state.angularMomentum[at(c.bodyB)] += cross(p - frames_[at(c.bodyB)].p, force) + torque;
  if (c.nodeA >= 0) state.angularMomentum[at(c.bodyA)] -= cross(p - frames_[at(c.bodyA)].p, force) + torque;
}

/// Adds the known axis forces of one constraint to the impulses of its rows, and their work.
void EulerStep::addAxes(int k, std::array<double, 6>& total, State& state, double dt) {
  for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a) {
    const std::size_t row = at(system_.axes()[at(a)].row);
    const AxisLaw& law = laws_[at(a)];
    const double newRate = system_.rate(k, static_cast<int>(row), state.twist);
    total[row] += dt * law.force;
    const double path = 0.5 * dt * (oldRate_[at(a)] + newRate);
    const AxisWork work = axisLaws_.work(law, impulse_[at(k)][row] / dt, newRate, path, dt);
    state.ledger.driveWork += work.drive;
    state.ledger.springWork += work.spring;
    state.ledger.dissipated += work.dissipated;
    stepLedger_.jointDamping += work.joint, stepLedger_.springDamping += work.springs,
        stepLedger_.stopDamping += work.stops;
    newRates_[at(a)] = newRate;
  }
}

void EulerStep::readConstraint(int k, State& state, double dt) {
  const Constraint& c = system_.constraints()[at(k)];
  const RowDirections& rows = system_.rows(k);
  const JointFrames after = trialFramesOf(k);
  std::array<double, 6> total = impulse_[at(k)];
  addAxes(k, total, state, dt);

  Vec3d force, torque;
  for (std::size_t r = 0; r < 6; ++r) {
    force += total[r] * rows.force[r];
    torque += total[r] * rows.torque[r];
  }
  addAngularMomentum(k, force, torque, state);
  recordConstraint(k, force, torque, state);

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

/// Readings of the axes of a joint; `total`: impulses of its rows.
void EulerStep::readAxes(int k, const std::array<double, 6>& total, State& state, double dt) const {
  const Constraint& c = system_.constraints()[at(k)];
  const auto read = [&](int a, auto& axis) {
    const std::size_t row = at(system_.axes()[at(a)].row);
    const AxisLaw& law = laws_[at(a)];
    axis.position = trialPosition(state, a);
    axis.rate = newRates_[at(a)];
    axis.axisForce = total[row] / dt;
    axis.driveForce = law.driven ? impulse_[at(k)][row] / dt : 0;
    if (law.driveForce != 0) axis.driveForce += law.driveForce;
    axis.springForce = law.springKnown - law.springInverseCompliance / dt * newRates_[at(a)];
  };
  for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a)
    if (c.kind == ConstraintKind::kCylindrical && system_.axes()[at(a)].row == kSlideRow)
      read(a, state.slide[at(c.source)]);
    else
      read(a, state.joint[at(c.source)]);
}

EulerStep::EulerStep(const Problem& problem)
    : model_(problem.model), options_(problem.options), system_(problem.system), driveStart_(problem.driveStart),
      last_(problem.last), axisLaws_(model_, system_), laws_(system_.axes().size()), x_(at(system_.nodes())),
      steps_(system_.links().size()), impulse_(system_.constraints().size()),
      couplingImpulse_(system_.couplings().size()), oldRate_(system_.axes().size(), 0.0),
      newRates_(system_.axes().size(), 0.0), oldMotion_(system_.constraints().size()),
      oldCouplingRate_(2 * system_.couplings().size()), mixing_(system_, model_), newTwist_(model_.bodies().size()) {
  std::vector<Pose> poses;
  for (const Body& body : model_.bodies()) poses.push_back(body.pose);
  system_.place(poses, frames_);
  trial_ = frames_;
  placed_.reserve(poses.size());
  for (const AxisSpring& spring : model_.axisSprings()) {
    const auto joint = at(spring.joint);
    springPlace_.push_back(
        {joint, model_.joints()[joint].type == JointType::kCylindrical && spring.axis == JointAxis::kSlide});
  }
  oldLength_.reserve(springPlace_.size() + model_.pointSprings().size() + 6 * model_.bushings().size());
  for (std::size_t i = 0; i < steps_.size(); ++i)
    for (std::size_t l = 0; l < kLanes; ++l)
      steps_[i].spread[l] = spreadOf(model_.bodies()[at(system_.links()[i].body[l])].inertia_B);
}

void EulerStep::step(State& state, const Loads& loads, double dt) {
  // If no body has moved since the last step, its final frames are still valid.
  if (placed_.size() == state.pose.size() &&
      std::memcmp(placed_.data(), state.pose.data(), placed_.size() * sizeof(Pose)) == 0)
    std::swap(frames_, trial_);
  else
    system_.place(state.pose, frames_);
  placed_.clear(); // invalid until the step has succeeded
  axisLaws_.evaluate(system_, state, loads, dt, frames_, driveStart_, laws_);
  noteOldLengths(state);
  oldSpin_ = state.angularMomentum;
  for (const ConstraintSystem::Part& part : system_.parts()) solvePart(part, state, loads, dt);
  recordElasticGain(state, loads);
  state.time += dt;
  placed_ = state.pose;
}

} // namespace grouser::multibody::detail
