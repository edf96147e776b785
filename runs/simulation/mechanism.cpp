// SPDX-License-Identifier: BSD-3-Clause
#include "runs/simulation/mechanism.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "multibody/readings.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

namespace grouser::simulation {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The longest stable step goes as the inverse root of the tension. It is computed again when the largest force reaches
/// kTensionShare of what the present step bears, but not before it has grown kLeastGrowth times (an unstable
/// oscillation soon does), and when it has grown kMostGrowth times at the latest, since poses change too [-].
constexpr double kTensionShare = 0.5, kLeastGrowth = 1.05, kMostGrowth = 4;

} // namespace

Mechanism::Mechanism(const setup::MechanismSetup& setup, double timeStep)
    : timeStep_(timeStep), model_(setup.model), state_(multibody::makeState(model_)),
      loads_(multibody::makeLoads(model_)), solver_(model_, setup.solver),
      startBlow_(setup::beginMotion(setup, solver_, state_, loads_)) {}

void Mechanism::advance() {
  try {
    solver_.step(state_, loads_, timeStep_);
  } catch (const base::SimulationError& error) {
    throw base::SimulationError(tensionStepWarning_.empty() ? error.what()
                                                            : fmt::format("{}; {}", error.what(), tensionStepWarning_));
  }
  const multibody::StepReport& report = solver_.lastStep();
  worst_.position = std::max(worst_.position, report.maxPositionError);
  worst_.iterations = std::max(worst_.iterations, report.iterations);
  worst_.singularSteps += report.singularRows > 0;
  if (tensionStepWarning_.empty()) watchTension();
}

/// Growing forces in joints and springs lower the longest stable step. That is only noted here: a peak may pass before
/// any oscillation has grown. The first tension that the step does not bear is kept, not the largest: later ones
/// contain the forces of the oscillation itself.
void Mechanism::watchTension() {
  double force = 0;
  for (const multibody::JointReading& joint : state_.joint) force = std::max(force, norm(joint.force));
  for (const multibody::SpringReading& spring : state_.spring) force = std::max(force, std::fabs(spring.force));
  if (!(force > boundedTension_)) return;
  const double most = checkTension();
  boundedTension_ =
      force * std::clamp(kTensionShare * (most / timeStep_) * (most / timeStep_), kLeastGrowth, kMostGrowth);
}

/// The longest step that is stable under the present tension [s].
double Mechanism::checkTension() {
  std::string part;
  const double most = stableStepUnderTension(&part);
  if (timeStep_ >= most)
    tensionStepWarning_ =
        fmt::format("at {:.4g} s {} bore so much that only steps below {:.2g} s are stable", state_.time, part, most);
  return most;
}

const std::string& Mechanism::tensionStepWarning() {
  if (tensionStepWarning_.empty()) checkTension();
  return tensionStepWarning_;
}

Mechanism::DriveReading Mechanism::drive(int index) const {
  return {model_.drives()[at(index)].law.value(state_.time), multibody::driveForce(model_, state_, index),
          multibody::drivePower(model_, state_, index)};
}

double Mechanism::axisSpringForce(int index) const {
  const multibody::AxisSpring& s = model_.axisSprings()[at(index)];
  const multibody::AxisReading axis = multibody::axisReading(model_, state_, s.joint, s.axis);
  return s.preload - s.stiffness * (axis.position - s.freePosition) - s.damping * axis.rate;
}

Mechanism::Ledger Mechanism::ledger() const {
  const multibody::Totals t = multibody::totals(model_, state_, loads_);
  const multibody::Balance b = multibody::balance(model_, state_, loads_);
  Ledger ledger;
  ledger.driveWork = b.driveWork;
  ledger.kinetic = t.kinetic, ledger.potential = t.gravity, ledger.elastic = t.elastic;
  ledger.jointDamping = b.jointDamping, ledger.springDamping = b.springDamping, ledger.stopDamping = b.stopDamping;
  ledger.dissipated = b.dissipated();
  ledger.integrationError = b.integrationError, ledger.leftOver = b.leftOver, ledger.turnover = b.turnover;
  ledger.linearMomentum = t.linearMomentum, ledger.angularMomentum = t.angularMomentum;
  ledger.linearLeftOver = b.linearLeftOver, ledger.angularLeftOver = b.angularLeftOver;
  return ledger;
}

void Mechanism::addTo(simulation::Ledger& l) const {
  const Ledger m = ledger();
  l.driveWork += m.driveWork, l.kinetic += m.kinetic, l.work += m.kinetic - m.leftOver, l.turnover += m.turnover;
  l.potential += m.potential, l.elastic += m.elastic, l.dissipated.joints += m.dissipated;
  l.momentum += m.linearMomentum, l.angularMomentum += m.angularMomentum;
  l.momentumResidual += m.linearLeftOver, l.angularResidual += m.angularLeftOver;
}

Mechanism::Drift Mechanism::drift() const {
  Drift drift = worst_;
  drift.velocity = solver_.velocityError(state_);
  return drift;
}

std::vector<std::uint32_t> MechanismState::words() const {
  if (bodies.empty()) return {};
  const std::size_t count = bodies.size() - multibody::State::kBooks;
  std::vector<std::uint32_t> words(2 * count);
  std::memcpy(words.data(), bodies.data(), count * sizeof(double));
  return words;
}

MechanismState Mechanism::save() const {
  return {state_.save(),
          {worst_.position, static_cast<double>(worst_.iterations), static_cast<double>(worst_.singularSteps)}};
}

void Mechanism::restore(const MechanismState& saved) {
  state_.restore(saved.bodies);
  if (saved.worst.size() != 3)
    throw base::InputError("the checkpoint is of another mechanism; resume with the scene that was run");
  worst_ = {saved.worst[0], 0, static_cast<int>(saved.worst[1]), static_cast<int>(saved.worst[2])};
}

} // namespace grouser::simulation
