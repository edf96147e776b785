// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/mechanism.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "base/rounded.hpp"
#include "coupling/ledger_entries.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::coupling {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The longest stable step is proportional to 1 / sqrt(tension). It is recomputed when the largest force reaches
/// kTensionShare of the limit for the current step, but not before this force has grown by kMinGrowth (as it soon
/// does in an unstable oscillation), and at the latest when it has grown by kMaxGrowth, since poses change too [-].
constexpr double kTensionShare = 0.5, kMinGrowth = 1.05, kMaxGrowth = 4;

/// Steps per bounce off an end stop, as chosen by "auto" [-].
constexpr double kBounceSteps = 20;

/// Tolerance for rounded input of the rotation per step [-].
constexpr double kTurnDigits = 1e-6;

} // namespace

Mechanism::Mechanism(const MechanismSetup& setup, double timeStep, const base::Exec& exec, Ground* ground,
                     const std::vector<Obstacle>& obstacles, SphereSets* kept)
    : timeStep_(timeStep), largestTurn_(setup.largestTurn), model_(setup.model), solver_(model_, setup.solver) {
  state_ = multibody::makeState(model_), loads_ = multibody::makeLoads(model_);
  startBlow_ = beginMotion(setup, solver_, state_, loads_);
  if (setup.control) controller_ = std::make_unique<StepController>(*setup.control, setup.largestTurn);
  for (const multibody::Twist& V : state_.twist) startTurn_.push_back(timeStep_ * norm(V.w));
  if (setup.shapes.empty()) return;
  const GroundTraits traits = ground ? ground->traits() : GroundTraits{};
  addBodies(setup, model_, traits, kept);
  replicated_ = traits.replicated, maxTravel_ = 0.5 * std::min(traits.smallestGrain, contactParts_.contactSize);
  contacts_ = std::make_unique<PartContacts>(contactParts_, nullptr, obstacles, exec, timeStep_, ground, kept);
}

void Mechanism::fail(base::Cause cause, const std::string& message) const {
  throw base::SimulationError(fmt::format("step {}, time {:.4g} s: {}", steps_, state_.time, message), cause);
}

void Mechanism::require(const Input& input) const {
  if (input.kind == InputKind::gravity) return;
  if (input.kind != InputKind::bodyLoad)
    throw base::InputError(
        fmt::format("a mechanism has no input {}; it accepts gravity and body_load", base::wordOf(input.kind)));
  if (input.target < 0 || at(input.target) >= model_.bodies().size())
    throw base::InputError(
        fmt::format("the mechanism has no body {}; it has {} bodies", input.target, model_.bodies().size()));
}

void Mechanism::command(const Inputs& inputs, const base::Vec3d& gravity) {
  loads_.gravity = gravity;
  if (contacts_) return applied_.set(inputs); // advance() adds these to the contact loads
  for (multibody::Wrench& wrench : loads_.external) wrench = {};
  for (const Input& i : inputs.acting())
    if (i.kind == InputKind::bodyLoad)
      loads_.external[at(i.target)] = {{i.value[0], i.value[1], i.value[2]}, {i.value[3], i.value[4], i.value[5]}};
}

void Mechanism::actuate() {
  if (contacts_) applied_.add(state_, loads_);
}

void Mechanism::advance() {
  if (controller_) {
    controller_->advance(solver_, state_, loads_, static_cast<double>(steps_ + 1) * timeStep_,
                         [this] { watchDrift(); });
    ++steps_;
    return;
  }
  try {
    replicated_.run([this] { solver_.step(state_, loads_, timeStep_); });
  } catch (const base::SimulationError& error) {
    throw base::SimulationError(tensionStepWarning_.empty() ? error.what()
                                                            : fmt::format("{}; {}", error.what(), tensionStepWarning_),
                                error.cause());
  } catch (const base::InputError& error) { // the step was stable at the start, but is no longer
    fail(base::Cause::growingSwings, error.what());
  }
  ++steps_;
  if (contacts_) applied_.accountWork(state_, timeStep_), contacts_->trackTravel(state_), checkTravel();
  watchDrift();
  if (!overTension_) watchTension();
  if (steps_ % kJudgeInterval == 0) judge();
}

/// A surface that moves half the radius of a grain, or a quarter of the thickness of a shape, in one step could pass
/// through it without contact.
void Mechanism::checkTravel() const {
  const double way = contacts_->lastTravel();
  if (!(way > maxTravel_)) return;
  std::size_t fastest = 0;
  double speed = -1;
  for (const ContactPart& part : contactParts_.parts) {
    const multibody::Twist& V = state_.twist[part.body];
    if (const double bound = norm(V.v) + norm(V.w) * part.reach; bound > speed) speed = bound, fastest = part.body;
  }
  fail(base::Cause::thrownPart,
       fmt::format("body \"{}\" moves at up to {:.4g} m/s, {:.4g} m a step, more than {:.4g} m, half the radius of the "
                   "smallest grain or a quarter of the thinnest shape: it could pass through without contact; set "
                   "run.time_step to {} s or less, or limit its drive",
                   model_.bodies()[fastest].name, speed, way, maxTravel_, base::roundedDown(maxTravel_ / speed, 4)));
}

void Mechanism::watchDrift() {
  const multibody::StepReport& report = solver_.lastStep();
  worst_.position = std::max(worst_.position, report.maxPositionError);
  worst_.iterations = std::max(worst_.iterations, report.iterations);
  worst_.singularSteps += report.singularRows > 0;
}

void Mechanism::judge() {
  if (overTension_) judgeTension();
  judgeTurns();
}

/// A large rotation per step makes a body precess too slowly: with moments of inertia 1, 1, 2 and spin (0.5, 0, 1), by
/// 0.07 % at 0.1 rad per step, 0.65 % at 20 steps per turn, and 3.4 % at 0.75 rad per step (measured).
void Mechanism::judgeTurns() const {
  for (std::size_t b = 0; b < state_.twist.size(); ++b) {
    const double rate = norm(state_.twist[b].w), turn = timeStep_ * rate;
    if (turn <= largestTurn_ * (1 + kTurnDigits)) continue;
    const std::string spunUp =
        turn > 2 * startTurn_[b] ? fmt::format(" (spun up from {:.4g} rad a step at the start)", startTurn_[b]) : "";
    fail(base::Cause::fastTurn,
         fmt::format("body \"{}\" rotates by {:.4g} rad a step{}, more than {:.4g} rad (run.steps_per_period = {:g} "
                     "steps a turn), so its motion is not resolved; set run.time_step to {} s or less, limit its "
                     "drive, or lower run.steps_per_period if this is intended{}",
                     model_.bodies()[b].name, turn, spunUp, largestTurn_, 2 * base::kPi / largestTurn_,
                     base::roundedDown(largestTurn_ / rate, 4),
                     tensionStepWarning_.empty() ? "" : "; " + tensionStepWarning_));
  }
}

void Mechanism::judgeTension() {
  std::string part;
  const double r = timeStep_ / stableStepUnderTension(&part);
  overTension_ = r > 1;
  if (swings_.bears(r, kJudgeInterval)) return;
  fail(base::Cause::growingSwings,
       fmt::format(
           "transverse oscillations of tensioned joints may have grown {:g} times: the time step stays above the "
           "stability limit, now {:.3g} times ({}): {}; set run.time_step to {} s or less",
           SwingGrowth::kMax, r, part, tensionStepWarning_, base::roundedDown(0.5 * timeStep_ / r, 4)));
}

/// Growing forces in joints and springs reduce the longest stable step. The limit is recorded, and enforced from the
/// next check on: a peak may pass before any oscillation has grown. The first tension above the limit is kept, not the
/// largest, since later tensions include the forces of the oscillation itself.
void Mechanism::watchTension() {
  double force = 0;
  for (const multibody::JointReading& joint : state_.joint) force = std::max(force, norm(joint.force));
  for (const multibody::SpringReading& spring : state_.spring) force = std::max(force, std::fabs(spring.force));
  if (!(force > boundedTension_)) return;
  const double most = checkTension();
  overTension_ = timeStep_ >= most;
  boundedTension_ = force * std::clamp(kTensionShare * (most / timeStep_) * (most / timeStep_), kMinGrowth, kMaxGrowth);
}

/// Longest stable step under the current tension [s].
double Mechanism::checkTension() {
  std::string part;
  const double most = stableStepUnderTension(&part);
  if (timeStep_ >= most && tensionStepWarning_.empty())
    tensionStepWarning_ =
        fmt::format("at {:.4g} s the load on {} limits stable steps to {:.2g} s", state_.time, part, most);
  return most;
}

const std::string& Mechanism::tensionStepWarning() {
  if (tensionStepWarning_.empty()) checkTension();
  return tensionStepWarning_;
}

std::string Mechanism::bounceNote() {
  std::string stop;
  const double rate = controller_ ? 0 : solver_.stopRate(state_, loads_, &stop);
  const double steps = rate > 0 ? base::kPi / (rate * timeStep_) : kBounceSteps;
  if (steps >= kBounceSteps) return {};
  return fmt::format("a bounce off {} lasts {:.2g} s, {:.2g} steps; it needs {:g} steps", stop, base::kPi / rate, steps,
                     kBounceSteps);
}

void Mechanism::addTo(Ledger& l) const {
  multibody::Balance bodies = bodiesBalance();
  bodies.driveWork += contacts_ ? applied_.work() : bodies.externalWork;
  enter(l, bodies, bodies.now.gravity, bodies.now.elastic);
}

Mechanism::Drift Mechanism::drift() const {
  Drift drift = worst_;
  drift.velocity = solver_.velocityError(state_);
  return drift;
}

std::vector<std::uint32_t> MechanismState::words() const {
  std::vector<double> all = bodies;
  if (!all.empty()) all.resize(all.size() - multibody::State::kBooks);
  if (!control.empty() && control.front() > 0) all.push_back(control.front());
  std::vector<std::uint32_t> words;
  addWords(words, all.data(), all.size());
  if (!touching) return words;
  const std::vector<std::uint32_t> contacts = touching->contacts.words();
  words.insert(words.end(), contacts.begin(), contacts.end());
  return words;
}

MechanismState Mechanism::save() const {
  const StepController::Record steps = controller_ ? controller_->record() : StepController::Record{};
  MechanismState s{
      state_.save(),
      {worst_.position, static_cast<double>(worst_.iterations), static_cast<double>(worst_.singularSteps)},
      {static_cast<double>(steps_), boundedTension_, overTension_ ? 1.0 : 0.0, swings_.save()[0], swings_.save()[1]},
      {steps.next, static_cast<double>(steps.taken), static_cast<double>(steps.rejected), steps.smallest,
       steps.largest},
      {}};
  if (!contacts_) return s;
  TouchingState& t = s.touching.emplace();
  contacts_->save(t.contacts);
  t.forces = rowMeans_.sums, t.meanSteps = rowMeans_.steps;
  t.appliedWork = applied_.save();
  return s;
}

void Mechanism::restore(const MechanismState& saved) {
  state_.restore(saved.bodies);
  if (saved.worst.size() != 3 || saved.judged.size() != 5 || saved.control.size() != 5 ||
      saved.touching.has_value() != touches() ||
      (touches() && saved.touching->forces.size() > contactParts_.count() + contacts_->surfaces()))
    throw base::InputError("the checkpoint belongs to another mechanism; resume with the scene that was run");
  worst_ = {saved.worst[0], 0, static_cast<int>(saved.worst[1]), static_cast<int>(saved.worst[2])};
  steps_ = static_cast<std::int64_t>(saved.judged[0]);
  boundedTension_ = saved.judged[1];
  overTension_ = saved.judged[2] != 0;
  swings_.restore(saved.judged[3], saved.judged[4]);
  if (overTension_) checkTension();
  const std::vector<double>& c = saved.control;
  if (controller_)
    controller_->restore({c[0], static_cast<std::int64_t>(c[1]), static_cast<std::int64_t>(c[2]), c[3], c[4]});
  if (!saved.touching) return;
  contacts_->restore(saved.touching->contacts);
  rowMeans_ = {saved.touching->forces, saved.touching->meanSteps};
  applied_.restore(saved.touching->appliedWork);
}

} // namespace grouser::coupling
