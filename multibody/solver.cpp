// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/solver.hpp"

#include "base/error.hpp"
#include "multibody/detail/euler_step.hpp"
#include "multibody/detail/geometric_stiffness.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/rattle_step.hpp"
#include "multibody/detail/reaction_sharing.hpp"
#include "multibody/detail/redundancy.hpp"
#include "multibody/detail/stability.hpp"
#include "multibody/detail/start_checks.hpp"
#include "multibody/detail/velocity_projection.hpp"
#include "multibody/readings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>

namespace grouser::multibody {

using namespace detail;

namespace {

SolverOptions resolved(const SolverOptions& given) {
  SolverOptions o = given;
  const bool rattle = o.integrator == Integrator::kRattle;
  if (o.positionTolerance == 0) o.positionTolerance = rattle ? kRattleTolerance : kEulerTolerance;
  if (o.maxIterations == 0) o.maxIterations = rattle ? 40 : 12;
  if (!(o.positionTolerance > 0 && std::isfinite(o.positionTolerance)))
    throw base::InputError("multibody: positionTolerance must be > 0 [m, rad]");
  if (!(o.momentLength >= 0 && std::isfinite(o.momentLength)))
    throw base::InputError("multibody: momentLength must be >= 0 [m]");
  if (o.maxIterations < 1) throw base::InputError("multibody: maxIterations must be >= 1");
  if (o.order != 2 && o.order != 4 && o.order != 6 && o.order != 8)
    throw base::InputError("multibody: order = " + std::to_string(o.order) + " must be 2, 4, 6 or 8");
  return o;
}

} // namespace

struct Solver::Impl {
  Impl(const Model& m, const SolverOptions& o)
      : model(m), options(resolved(o)), system(m), laws(system.axes().size()), stiffness(system.axes().size()),
        x(at(system.nodes())) {
    checkClosed(system, m);
    redundancy = findRedundantRows(system, m);
    checkCouplings(system, m);
    checkDrives(system, m);
    const bool rattle = options.integrator == Integrator::kRattle;
    // With kSymplecticEuler twists are means over steps; an imposed rate applies to the first step, not to its start.
    if (options.startVelocities == StartVelocities::kRefuse)
      checkVelocities(system, m, options.velocityTolerance, rattle);
    start = driveStart(system, m);
    countFreedom();
    describe();
    const Problem problem{model, options, system, start, last};
    if (rattle)
      stepper = std::make_unique<RattleStep>(problem);
    else
      stepper = std::make_unique<EulerStep>(problem);
  }

  void countFreedom();
  void describe();
  void checkFits(const State& state, const Loads& loads) const;
  double stabilityLimit() const {
    return options.integrator == Integrator::kRattle ? detail::stabilityLimit(options.order) : 2;
  }
  double highestRate(const State& state, const Loads& loads, std::string* spring);
  double stableStep(const State& state, const Loads& loads, std::string* spring);
  double stopRate(const State& state, const Loads& loads, std::string* stop);
  double dampingRate(const State& state, const Loads& loads, std::string* damper);
  double geometricStiffnessRate(const State& state, const Loads& loads, std::string* name);
  void checkDampers(double dt);
  void checkStable(const State& state, const Loads& loads, double dt);

  const Model& model;
  SolverOptions options;
  ConstraintSystem system;
  Redundancy redundancy;
  std::vector<double> start; ///< start positions of the drives
  int freedom = 0;
  std::string text;
  StepReport last;
  std::unique_ptr<Stepper> stepper;

  double checkedStep = 0;                   ///< largest step found stable since the last check
  double checkedDampers = 0;                ///< largest step that the dampers allow
  std::vector<AxisLaw> laws;                ///< one per axis
  std::vector<double> stiffness;            ///< stiffness or damping, one per axis
  std::vector<Vector6> x;                   ///< one per node
  std::vector<Frame> frames;                ///< one per body, the world last
  std::unique_ptr<ReactionSharing> sharing; ///< created on the first request for reactions of redundant joints
};

/// Degrees of freedom at a generic position: redundant rows are known; couplings without a pivot are implied by others.
void Solver::Impl::countFreedom() {
  std::vector<Pose> poses;
  for (const Body& body : model.bodies()) {
    poses.push_back(body.pose);
    if (!body.fixed) freedom += body.point ? 3 : 6;
  }
  system.place(poses, frames);
  freedom += static_cast<int>(redundancy.rows.size());
  for (const ConstraintSystem::Part& part : system.parts()) {
    system.linearise(part, frames, laws);
    for (const int k : part.constraints) freedom -= __builtin_popcount(hardRows(system.constraints()[at(k)].kind));
    for (const int c : part.couplings)
      if (system.couplingKept(c))
        --freedom;
      else
        redundancy.couplings.push_back(c);
  }
}

void Solver::Impl::describe() {
  std::ostringstream out;
  int rows = 0;
  for (const Constraint& c : system.constraints()) rows += __builtin_popcount(hardRows(c.kind));
  rows -= static_cast<int>(redundancy.rows.size());
  out << "multibody: " << system.movableBodies() << " bodies, " << model.joints().size() << " joints, "
      << model.pointSprings().size() << " point springs, " << rows << " constraint rows, "
      << system.elimination().tree().independent << " independent parts, " << system.elimination().tree().loops.size()
      << " loops\n";
  if (!model.bushings().empty() || !model.couplings().empty())
    out << model.bushings().size() << " bushings, " << model.couplings().size() << " couplings\n";
  out << "degrees of freedom: " << freedom << '\n';
  out << "redundant rows: " << redundancy.rows.size() + redundancy.couplings.size();
  if (!redundancy.rows.empty() || !redundancy.couplings.empty())
    out << ", dropped (implied by other joints); reactions have least norm";
  out << '\n';
  for (const auto& [k, row] : redundancy.rows) out << "  " << system.describe(k, row) << '\n';
  for (const int c : redundancy.couplings) out << "  coupling '" << model.couplings()[at(c)].name << "'\n";
  if (redundancy.singularAtStart > 0)
    out << "the mechanism starts in a singular position: " << redundancy.singularAtStart
        << " rows are dependent only in this position; they are kept\n";
  text = out.str();
}

void Solver::Impl::checkFits(const State& state, const Loads& loads) const {
  if (state.pose.size() != model.bodies().size() || loads.external.size() != model.bodies().size() ||
      loads.axisSprings.size() != model.axisSprings().size() ||
      loads.pointSprings.size() != model.pointSprings().size() || loads.drives.size() != model.drives().size() ||
      loads.bushings.size() != model.bushings().size() || state.joint.size() != model.joints().size() ||
      state.bushing.size() != model.bushings().size() || state.coupling.size() != model.couplings().size())
    throw base::InputError("multibody step: state or loads belong to another model; use makeState and makeLoads");
}

/// Highest frequency [rad/s] of `stiffness` (one per axis) against the constrained masses.
double Solver::Impl::highestRate(const State& state, const Loads& loads, std::string* spring) {
  system.place(state.pose, frames);
  imposedLaws(system, model, loads, state.time, laws);
  double highest = 0;
  int worst = -1;
  for (const ConstraintSystem::Part& part : system.parts()) {
    system.linearise(part, frames, laws);
    int axis = -1;
    const double omega2 = highestFrequency(system, part, stiffness, x, axis);
    if (omega2 > highest) highest = omega2, worst = axis;
  }
  if (spring) *spring = worst < 0 ? "" : springName(system, model, worst);
  return std::sqrt(highest);
}

double Solver::Impl::stableStep(const State& state, const Loads& loads, std::string* spring) {
  axisStiffness(system, model, loads, stiffness);
  return stabilityLimit() / highestRate(state, loads, spring);
}

double Solver::Impl::stopRate(const State& state, const Loads& loads, std::string* stop) {
  stopStiffness(system, model, stiffness);
  return highestRate(state, loads, stop);
}

double Solver::Impl::dampingRate(const State& state, const Loads& loads, std::string* damper) {
  axisDamping(system, model, stiffness);
  const double rate = highestRate(state, loads, damper);
  return rate * rate;
}

double Solver::Impl::geometricStiffnessRate(const State& state, const Loads& loads, std::string* name) {
  system.place(state.pose, frames);
  imposedLaws(system, model, loads, state.time, laws);
  const SoftRows softRows(model, system, start);
  RowForces forces(system.constraints().size());
  double highest = 0;
  int worst = -1;
  for (const ConstraintSystem::Part& part : system.parts()) {
    system.linearise(part, frames, laws);
    findRowForces(system, model, part, frames, state, loads, softRows, x, forces);
    int constraint = -1;
    const double rate2 = highestGeometricFrequency(system, model, part, state.pose, forces, x, constraint);
    if (rate2 > highest) highest = rate2, worst = constraint;
  }
  if (name) *name = worst < 0 ? "" : system.describe(worst);
  return std::sqrt(highest);
}

/// Refuses strong dampers for orders above 2, which have backward stages: in these, a damper adds energy.
void Solver::Impl::checkDampers(double dt) {
  if (options.integrator != Integrator::kRattle || options.order == 2 || dt <= checkedDampers) return;
  axisDamping(system, model, stiffness);
  for (std::size_t a = 0; a < stiffness.size(); ++a) {
    const Axis& axis = system.axes()[a];
    // c dt / (2 m) of the longest backward stage; at 1 its midpoint rule has a pole.
    const double part = 0.35 * dt * stiffness[a] * system.rowSize(axis.constraint, axis.row);
    if (part <= 0.1) continue;
    std::ostringstream message;
    message << "multibody step: the damper of " << system.describe(axis.constraint, axis.row) << " (" << stiffness[a]
            << " [N s/m or N m s/rad]) is too strong for order " << options.order << " at dt = " << dt
            << " s, which has backward stages; use order 2, or dt <= " << 0.1 / part * dt << " s";
    throw base::InputError(message.str());
  }
  checkedDampers = dt;
}

/// Checks the step against explicit springs: before the first step, before longer steps, and periodically, since
/// frequencies depend on positions.
void Solver::Impl::checkStable(const State& state, const Loads& loads, double dt) {
  constexpr long long kInterval = 512;
  if (options.integrator != Integrator::kRattle || options.springs != Springs::kExplicit) return;
  if (model.axisSprings().empty() && model.pointSprings().empty() && model.bushings().empty()) return;
  // The check depends on time, not on a step counter, so that a resumed run checks the same steps.
  if (dt <= checkedStep && std::llround(state.time / dt) % kInterval != 0) return;
  std::string spring;
  const double limit = stableStep(state, loads, &spring);
  if (!(dt < limit)) {
    std::ostringstream message;
    message << "multibody step from t = " << state.time << " s: dt = " << dt << " s is beyond the stability limit "
            << limit << " s of explicit springs, set by " << spring
            << "; take a shorter step, a softer spring, or run.springs = \"implicit\"";
    throw base::InputError(message.str());
  }
  checkedStep = dt;
}

Solver::Solver(const Model& model, const SolverOptions& options) : impl_(std::make_unique<Impl>(model, options)) {}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;

void Solver::step(State& state, const Loads& loads, double dt) {
  Impl& s = *impl_;
  if (!(dt > 0 && std::isfinite(dt)))
    throw base::InputError("multibody step: dt = " + std::to_string(dt) + " [s] must be > 0");
  s.checkFits(state, loads);
  s.checkDampers(dt);
  s.checkStable(state, loads, dt);
  s.last = {};
  if (state.ledger.begun == 0) beginLedger(s.model, state, loads);
  s.stepper->step(state, loads, dt);
}

void Solver::startResponse(const State& state, const Loads& loads, double dt, std::vector<Twist>& twists) {
  impl_->checkFits(state, loads);
  impl_->stepper->startResponse(state, loads, dt, twists);
}

void Solver::respond(const std::vector<Wrench>& impulses, std::vector<Twist>& change) {
  impl_->stepper->respond(impulses, change);
}

double Solver::projectVelocities(State& state, const Loads& loads) {
  Impl& s = *impl_;
  s.checkFits(state, loads);
  const double before = totals(s.model, state, loads).kinetic;
  std::vector<Frame> frames;
  s.system.place(state.pose, frames);
  imposedLaws(s.system, s.model, loads, state.time, s.laws);
  for (const ConstraintSystem::Part& part : s.system.parts()) {
    s.system.linearise(part, frames, s.laws);
    std::vector<Twist> twist = state.twist;
    // A second pass reduces the round-off of the first.
    for (int pass = 0; pass < 2; ++pass) projectTwists(s.system, part, s.laws, s.x, twist);
    for (const int node : part.bodies)
      setTwist(s.model, state, s.system.bodyOf(node), twist[at(s.system.bodyOf(node))]);
  }
  readRates(s.system, state);
  return before - totals(s.model, state, loads).kinetic;
}

double Solver::stableStep(const State& state, const Loads& loads, std::string* spring) {
  impl_->checkFits(state, loads);
  return impl_->stableStep(state, loads, spring);
}

double Solver::stopRate(const State& state, const Loads& loads, std::string* stop) {
  impl_->checkFits(state, loads);
  return impl_->stopRate(state, loads, stop);
}

double Solver::dampingRate(const State& state, const Loads& loads, std::string* damper) {
  impl_->checkFits(state, loads);
  return impl_->dampingRate(state, loads, damper);
}

double Solver::geometricStiffnessRate(const State& state, const Loads& loads, std::string* part) {
  impl_->checkFits(state, loads);
  return impl_->geometricStiffnessRate(state, loads, part);
}

double Solver::stabilityLimit() const { return impl_->stabilityLimit(); }

double Solver::velocityError(const State& state) const {
  Impl& s = *impl_;
  std::vector<Frame> frames;
  s.system.place(state.pose, frames);
  double largest = 0;
  for (const Constraint& c : s.system.constraints()) {
    const JointFrames f = framesOf(c, frames[at(c.bodyA)], frames[at(c.bodyB)]);
    const RowDirections rows = rowDirections(c, f);
    for (int r = 0; r < 6; ++r)
      if (hardRows(c.kind) >> r & 1u)
        largest = std::max(largest, std::fabs(rowRate(c, f, rows, r, frames, state.twist)));
  }
  return largest;
}

std::vector<std::string> Solver::redundantRowNames() const {
  std::vector<std::string> names;
  for (const auto& [k, row] : impl_->redundancy.rows) names.push_back(impl_->system.describe(k, row));
  for (const int c : impl_->redundancy.couplings)
    names.push_back("coupling '" + impl_->model.couplings()[at(c)].name + "'");
  return names;
}

std::vector<JointReaction> Solver::reactions(const State& state) const {
  std::vector<JointReaction> reactions;
  for (const JointReading& joint : state.joint) reactions.push_back({joint.force, joint.torque});
  if (impl_->redundancy.rows.empty()) return reactions;
  if (!impl_->sharing)
    impl_->sharing = std::make_unique<ReactionSharing>(impl_->model, impl_->redundancy, impl_->options.momentLength);
  impl_->sharing->share(state, reactions);
  return reactions;
}

const StepReport& Solver::lastStep() const { return impl_->last; }
const std::string& Solver::report() const { return impl_->text; }
int Solver::degreesOfFreedom() const { return impl_->freedom; }

} // namespace grouser::multibody
