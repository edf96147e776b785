// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/solver.hpp"

#include "base/error.hpp"
#include "multibody/detail/axis_laws.hpp"
#include "multibody/detail/constraint_system.hpp"
#include "multibody/detail/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>

/// The scheme. Positions q at the nodes, twists u constant over each step, impulses Lambda at the nodes:
///
///   S(u_new) = S(u_old) + dt f(q) + J(q)^T Lambda        momentum (S: rotation.hpp; mass times velocity for the rest)
///   q_new = q moved by dt u_new                          rotation by exp(dt w)
///   C(q_new) = 0                                         hard rows
///   J(q) u_new + Lambda / (dt c + dt^2 k) = 0            soft rows (the known part of a spring's force is in f)
///   J(q) u_new = rate                                    driven rows
///
/// That is symplectic Euler with the constraint on positions (SHAKE; Hairer, Lubich and Wanner 2006, VII.1.4): no
/// drift, no stabilisation term, and the impulses that close the joints are the constraint forces themselves, so that
/// linear and angular momentum are conserved to round-off and energy has no secular loss. Solved by Newton's method
/// with the matrix of the velocity problem, factored once a step; the correction of an iteration is dt |w| times the
/// one before. Soft and driven rows are linear, are solved once, and are not moved by the corrections.
namespace grouser::multibody {

using namespace detail;

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A gap this wide after all iterations means that the step is too long for the motion [m, rad].
constexpr double kGapFailure = 1e-6;
/// Joints must be closed this well by who builds the model [m, rad].
constexpr double kStartGap = 1e-6;

Vec3d linear(const Vector6& x) { return {x[0], x[1], x[2]}; }
Vec3d angular(const Vector6& x) { return {x[3], x[4], x[5]}; }
void set(Vector6& x, const Vec3d& v, const Vec3d& w) {
  x[0] = v.x, x[1] = v.y, x[2] = v.z, x[3] = w.x, x[4] = w.y, x[5] = w.z;
}
void add(Vector6& x, const Vec3d& v, const Vec3d& w) {
  x[0] += v.x, x[1] += v.y, x[2] += v.z, x[3] += w.x, x[4] += w.y, x[5] += w.z;
}

} // namespace

struct Solver::Impl {
  Impl(const Model& m, const SolverOptions& o)
      : model(m), options(o), system(m), axisLaws(m, system.constraints()), laws(system.constraints().size()),
        x(at(system.movableBodies()) + system.constraints().size()), impulse(system.constraints().size()),
        oldRate(system.constraints().size(), 0.0), gyro(at(system.movableBodies())), newTwist(m.bodies().size()),
        trialPose(m.bodies().size()), trialFrames(system.constraints().size()) {
    if (o.integrator != Integrator::kSymplecticEuler) throw base::InputError("multibody: kRattle is not available");
    if (options.positionTolerance == 0) options.positionTolerance = 1e-10;
    if (options.maxIterations == 0) options.maxIterations = 12;
    for (const Body& body : m.bodies()) trialPose.at(static_cast<std::size_t>(&body - m.bodies().data())) = body.pose;
    system.place(trialPose, frames);
    trial = frames;
    checkClosed();
    redundancy = findRedundantRows(system, m);
    describe();
  }

  void checkClosed() const;
  void describe();
  void solvePart(const ConstraintSystem::Part& part, State& state, const Loads& loads, double dt);
  void setFirstResidual(const ConstraintSystem::Part& part, const State& state, const Loads& loads, double dt);
  void applyCorrection(const ConstraintSystem::Part& part);
  void moveTrial(const ConstraintSystem::Part& part, const State& state, double dt);
  double setGapResidual(const ConstraintSystem::Part& part, double dt, int& worst);
  double setGyroResidual(const ConstraintSystem::Part& part, double dt);
  void finish(const ConstraintSystem::Part& part, State& state, const Loads& loads, double dt);
  void readConstraint(int k, State& state, double dt);
  int rowNode(int k) const { return system.movableBodies() + k; }

  const Model& model;
  SolverOptions options;
  ConstraintSystem system;
  AxisLaws axisLaws;
  Redundancy redundancy;
  std::string text;
  StepReport last;

  std::vector<AxisLaw> laws;                  ///< one a constraint
  std::vector<Vector6> x;                     ///< residuals in, corrections out; one a node
  std::vector<std::array<double, 6>> impulse; ///< Lambda, one a constraint
  std::vector<double> oldRate;                ///< of the soft or driven row, before the step
  std::vector<Vec3d> gyro;                    ///< gyroscopic momentum at the current iterate, one a movable body
  std::vector<Twist> newTwist;                ///< current iterate, one a body
  std::vector<Pose> trialPose;                ///< one a body
  std::vector<Frame> frames, trial;           ///< bodies' frames at the start and at the end of the step
  std::vector<JointFrames> trialFrames;       ///< one a constraint
};

void Solver::Impl::checkClosed() const {
  for (std::size_t k = 0; k < system.constraints().size(); ++k) {
    const Constraint& c = system.constraints()[k];
    double error[6];
    positionError(c, framesOf(c, frames[at(c.bodyA)], frames[at(c.bodyB)]), error);
    for (int r = 0; r < 6; ++r)
      if (!(std::fabs(error[r]) <= kStartGap)) {
        std::ostringstream message;
        message << system.describe(static_cast<int>(k), r) << " is open by " << error[r]
                << " [m or rad] at the start; allowed are " << kStartGap << "; place the bodies so that it closes";
        throw base::InputError(message.str());
      }
  }
}

void Solver::Impl::describe() {
  std::ostringstream out;
  int rows = 0;
  for (std::size_t k = 0; k < system.constraints().size(); ++k)
    rows += __builtin_popcount(system.hardRowsOf(static_cast<int>(k)));
  out << "multibody: " << system.movableBodies() << " bodies, " << model.joints().size() << " joints, "
      << model.pointSprings().size() << " point springs, " << rows << " constraint rows, " << system.parts().size()
      << " independent parts, " << system.elimination().blocks() << " blocks in the factor\n";
  out << "redundant rows: " << redundancy.rows.size();
  if (!redundancy.rows.empty()) out << ", dropped (other joints imply them; their reactions read 0)";
  out << '\n';
  for (const auto& [k, row] : redundancy.rows) out << "  " << system.describe(k, row) << '\n';
  if (redundancy.singularAtStart > 0)
    out << "the mechanism starts in a singular position: " << redundancy.singularAtStart
        << " rows depend on others there and only there; they are kept\n";
  text = out.str();
}

void Solver::Impl::setFirstResidual(const ConstraintSystem::Part& part, const State& state, const Loads& loads,
                                    double dt) {
  for (const int node : part.bodies) {
    const int b = system.bodyOf(node);
    const Wrench& wrench = loads.external[at(b)];
    const Twist& V = state.twist[at(b)];
    gyro[at(node)] = gyroscopicMomentum(system.inertia(node), V.w, dt);
    set(x[at(node)], dt * (wrench.force + model.bodies()[at(b)].mass * loads.gravity),
        (state.spinMomentum[at(b)] - system.inertia(node) * V.w) - gyro[at(node)] + dt * wrench.torque);
    newTwist[at(b)] = V;
  }
  for (const int k : part.constraints) {
    impulse[at(k)] = {};
    const int row = axisLaws.row(k);
    if (row < 0) continue;
    const Constraint& c = system.constraints()[at(k)];
    oldRate[at(k)] = system.rate(k, row, state.twist);
    // The known force of a spring acts along its row.
    const Vec3d force = dt * laws[at(k)].force * system.rows(k).force[at(row)];
    const Vec3d torque = dt * laws[at(k)].force * system.rows(k).torque[at(row)];
    const Vec3d& p = system.jointFrames(k).p_B;
    if (c.nodeB >= 0) {
      add(x[at(c.nodeB)], force, cross(p - frames[at(c.bodyB)].p, force) + torque);
    }
    if (c.nodeA >= 0) {
      add(x[at(c.nodeA)], -force, -(cross(p - frames[at(c.bodyA)].p, force) + torque));
    }
  }
}

void Solver::Impl::moveTrial(const ConstraintSystem::Part& part, const State& state, double dt) {
  for (const int node : part.bodies) {
    const int b = system.bodyOf(node);
    const Pose& X = state.pose[at(b)];
    trialPose[at(b)].position = X.position + dt * newTwist[at(b)].v;
    trialPose[at(b)].orientation = (rotationBy(dt * newTwist[at(b)].w) * X.orientation).normalized();
    system.placeBody(b, trialPose[at(b)], trial);
  }
}

double Solver::Impl::setGapResidual(const ConstraintSystem::Part& part, double dt, int& worst) {
  double largest = 0;
  const double scale = -1 / dt;
  for (const int k : part.constraints) {
    const Constraint& c = system.constraints()[at(k)];
    placeFrames(c, trial[at(c.bodyA)], trial[at(c.bodyB)], trialFrames[at(k)]);
    double error[6];
    positionError(c, trialFrames[at(k)], error);
    Vector6& residual = x[at(rowNode(k))];
    const unsigned hard = system.hardRowsOf(k);
    for (int r = 0; r < 6; ++r) {
      const double gap = hard >> r & 1u ? error[r] : 0;
      residual[at(r)] = scale * gap;
      // Written so that a gap that is not a number counts as the largest.
      if (!(std::fabs(gap) <= largest)) largest = std::fabs(gap), worst = k;
    }
  }
  return largest;
}

double Solver::Impl::setGyroResidual(const ConstraintSystem::Part& part, double dt) {
  double largest = 0;
  for (const int node : part.bodies) {
    const Mat3d& I = system.inertia(node);
    const Vec3d g = gyroscopicMomentum(I, newTwist[at(system.bodyOf(node))].w, dt);
    const Vec3d residual = gyro[at(node)] - g;
    gyro[at(node)] = g;
    set(x[at(node)], {}, residual);
    const double turn = dt * 3 / (I.m[0][0] + I.m[1][1] + I.m[2][2]) * norm(residual);
    if (!(turn <= largest)) largest = turn;
  }
  return largest;
}

void Solver::Impl::applyCorrection(const ConstraintSystem::Part& part) {
  system.solve(part, x);
  for (const int node : part.bodies) {
    Twist& V = newTwist[at(system.bodyOf(node))];
    V.v += linear(x[at(node)]);
    V.w += angular(x[at(node)]);
  }
  for (const int k : part.constraints)
    for (std::size_t r = 0; r < 6; ++r) impulse[at(k)][r] += x[at(rowNode(k))][r];
}

void Solver::Impl::solvePart(const ConstraintSystem::Part& part, State& state, const Loads& loads, double dt) {
  last.singularRows += system.linearise(part, frames, laws);

  // First solve from the old twist: the gap it would open already holds the curvature of the constraints.
  setFirstResidual(part, state, loads, dt);
  moveTrial(part, state, dt);
  int worst = -1;
  setGapResidual(part, dt, worst);
  for (const int k : part.constraints) {
    const int row = axisLaws.row(k);
    if (row >= 0) x[at(rowNode(k))][at(row)] = (laws[at(k)].driven ? laws[at(k)].speed : 0) - oldRate[at(k)];
  }

  double gap = 0;
  int iteration = 0;
  for (;;) {
    applyCorrection(part);
    moveTrial(part, state, dt);
    ++iteration;
    gap = setGapResidual(part, dt, worst);
    const double turn = setGyroResidual(part, dt);
    if (gap <= options.positionTolerance && turn <= options.positionTolerance) break;
    if (iteration >= options.maxIterations) {
      if (gap <= kGapFailure) break;
      std::ostringstream message;
      message << "multibody step from t = " << state.time << " s";
      if (worst >= 0) message << ": " << system.describe(worst, 0) << " stays open by " << gap << " [m or rad]";
      message << " after " << iteration << " iterations; the motion is too fast for dt = " << dt
              << " s: reduce the step, or check the loads";
      throw base::SimulationError(message.str());
    }
  }
  last.iterations = std::max(last.iterations, iteration);
  last.maxPositionError = std::max(last.maxPositionError, gap);
  finish(part, state, loads, dt);
}

/// Work, momenta, readings and poses of one part once its impulses are known.
void Solver::Impl::finish(const ConstraintSystem::Part& part, State& state, const Loads& loads, double dt) {
  for (const int node : part.bodies) {
    const int b = system.bodyOf(node);
    const Wrench& wrench = loads.external[at(b)];
    const Twist &before = state.twist[at(b)], &after = newTwist[at(b)];
    const Vec3d path = 0.5 * dt * (before.v + after.v), turn = 0.5 * dt * (before.w + after.w);
    state.ledger.gravityWork += model.bodies()[at(b)].mass * dot(loads.gravity, path);
    state.ledger.externalWork += dot(wrench.force, path) + dot(wrench.torque, turn);
    state.spinMomentum[at(b)] += dt * wrench.torque;
    if (!std::isfinite(norm2(after.v) + norm2(after.w)))
      throw base::SimulationError("multibody step from t = " + std::to_string(state.time) +
                                  " s: the velocity of body '" + model.bodies()[at(b)].name +
                                  "' is not finite; check the loads on it");
  }
  for (const int k : part.constraints) readConstraint(k, state, dt);
  for (const int node : part.bodies) {
    const int b = system.bodyOf(node);
    state.twist[at(b)] = newTwist[at(b)];
    state.pose[at(b)] = trialPose[at(b)];
    frames[at(b)] = trial[at(b)];
  }
}

void Solver::Impl::readConstraint(int k, State& state, double dt) {
  const Constraint& c = system.constraints()[at(k)];
  const RowDirections& rows = system.rows(k);
  const int axis = axisLaws.row(k);
  const AxisLaw& law = laws[at(k)];
  std::array<double, 6> total = impulse[at(k)];
  double newRate = 0;
  if (axis >= 0) {
    newRate = system.rate(k, axis, newTwist);
    total[at(axis)] += dt * law.force;
    const double path = 0.5 * dt * (oldRate[at(k)] + newRate);
    const AxisWork work = axisLaws.work(law, impulse[at(k)][at(axis)] / dt, newRate, path, dt);
    state.ledger.driveWork += work.drive;
    state.ledger.springWork += work.spring;
    state.ledger.dissipated += work.dissipated;
  }

  Vec3d force, torque;
  for (std::size_t r = 0; r < 6; ++r) {
    force += total[r] * rows.force[r];
    torque += total[r] * rows.torque[r];
  }
  const Vec3d& p = system.jointFrames(k).p_B;
  if (c.nodeB >= 0) state.spinMomentum[at(c.bodyB)] += cross(p - frames[at(c.bodyB)].p, force) + torque;
  if (c.nodeA >= 0) state.spinMomentum[at(c.bodyA)] -= cross(p - frames[at(c.bodyA)].p, force) + torque;

  if (c.kind == ConstraintKind::kPointSpring) {
    state.spring[at(c.source)] = {total[at(axis)] / dt, axisPosition(c, trialFrames[at(k)])};
    return;
  }
  JointReading& reading = state.joint[at(c.source)];
  reading.force = force * (1 / dt);
  reading.torque = torque * (1 / dt);
  if (axis < 0) return;
  reading.position = axisPositionAfter(c, system.jointFrames(k), trialFrames[at(k)], reading.position);
  reading.rate = newRate;
  reading.axisForce = total[at(axis)] / dt;
  reading.driveForce = law.driven ? impulse[at(k)][at(axis)] / dt : 0;
  reading.springForce = law.springKnown - law.springSoftness / dt * newRate;
}

Solver::Solver(const Model& model, const SolverOptions& options) : impl_(std::make_unique<Impl>(model, options)) {}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;

void Solver::step(State& state, const Loads& loads, double dt) {
  Impl& s = *impl_;
  const Model& m = s.model;
  if (!(dt > 0 && std::isfinite(dt)))
    throw base::InputError("multibody step: dt = " + std::to_string(dt) + " [s] must be > 0");
  if (state.pose.size() != m.bodies().size() || loads.external.size() != m.bodies().size() ||
      loads.axisSprings.size() != m.axisSprings().size() || loads.pointSprings.size() != m.pointSprings().size() ||
      loads.drives.size() != m.drives().size() || state.joint.size() != m.joints().size())
    throw base::InputError("multibody step: state or loads belong to another model; make them by makeState, makeLoads");

  s.last = {};
  s.system.place(state.pose, s.frames);
  s.axisLaws.evaluate(s.system, state, loads, dt, s.frames, s.laws);
  for (const ConstraintSystem::Part& part : s.system.parts()) s.solvePart(part, state, loads, dt);
  state.time += dt;
}

double Solver::velocityError(const State& state) const {
  Impl& s = *impl_;
  std::vector<Frame> frames;
  s.system.place(state.pose, frames);
  double largest = 0;
  for (std::size_t k = 0; k < s.system.constraints().size(); ++k) {
    const Constraint& c = s.system.constraints()[k];
    const Frame &A = frames[at(c.bodyA)], &B = frames[at(c.bodyB)];
    const JointFrames f = framesOf(c, A, B);
    const RowDirections rows = rowDirections(c, f);
    const auto rate = [&](const Vec3d& e, const Vec3d& t, int node, int body, const Frame& F) {
      return node < 0 ? 0.0 : dot(e, state.twist[at(body)].v) + dot(cross(f.p_B - F.p, e) + t, state.twist[at(body)].w);
    };
    for (int r = 0; r < 6; ++r)
      if (s.system.hardRowsOf(static_cast<int>(k)) >> r & 1u)
        largest = std::max(largest, std::fabs(rate(rows.force[at(r)], rows.torque[at(r)], c.nodeB, c.bodyB, B) -
                                              rate(rows.force[at(r)], rows.torque[at(r)], c.nodeA, c.bodyA, A)));
  }
  return largest;
}

double Solver::projectVelocities(State&, const Loads&) { throw base::InputError("multibody: not available"); }
double Solver::stableStep(const State&, const Loads&, std::string*) {
  throw base::InputError("multibody: not available");
}
std::vector<std::string> Solver::singularRowNames() const { return {}; }
std::vector<std::string> Solver::redundantRowNames() const { return {}; }
int Solver::degreesOfFreedom() const { return 0; }
const StepReport& Solver::lastStep() const { return impl_->last; }
const std::string& Solver::report() const { return impl_->text; }
int Solver::redundantRows() const { return static_cast<int>(impl_->redundancy.rows.size()); }

} // namespace grouser::multibody
