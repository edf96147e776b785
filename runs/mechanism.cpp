// SPDX-License-Identifier: BSD-3-Clause
#include "runs/mechanism.hpp"

#include "base/math.hpp"
#include "runs/mechanism_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

namespace grouser::runs {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Steps of a period or turn that "auto" gives [-], and the longest step it gives [s].
constexpr double kStepsPerPeriod = 100, kLongestStep = 1e-3;

/// The solver's errors about the mechanism as a whole, with the file.
multibody::Solver makeSolver(const Scene& scene, const multibody::Model& model) {
  try {
    return multibody::Solver(model, solverOptions(scene.run));
  } catch (const base::InputError& error) {
    throw base::InputError(fmt::format("{}: {}", scene.file.string(), error.what()));
  }
}

} // namespace

multibody::SolverOptions solverOptions(const RunSettings& run) {
  multibody::SolverOptions options;
  options.positionTolerance = run.constraintTolerance;
  return options;
}

Mechanism::Mechanism(const Scene& scene, double timeStep)
    : sections_(scene.mechanism), timeStep_(timeStep), model_(buildModel(scene.mechanism)),
      state_(multibody::makeState(model_)), loads_(multibody::makeLoads(model_)), solver_(makeSolver(scene, model_)) {
  loads_.gravity = scene.run.gravity;
}

void Mechanism::setDrives() {
  // A rate over the step is met best by the value in its middle.
  for (std::size_t d = 0; d < sections_.drives.size(); ++d)
    loads_.drives[d].speed = driveValue(sections_.drives[d], state_.time + 0.5 * timeStep_);
}

void Mechanism::advance() {
  setDrives();
  solver_.step(state_, loads_, timeStep_);
  const multibody::StepReport& report = solver_.lastStep();
  worst_.position = std::max(worst_.position, report.maxPositionError);
  worst_.iterations = std::max(worst_.iterations, report.iterations);
  worst_.singularSteps += report.singularRows > 0;
}

Mechanism::DriveReading Mechanism::drive(int index) const {
  const multibody::JointReading& joint = state_.joint[at(model_.drives()[at(index)].joint)];
  return {driveValue(sections_.drives[at(index)], state_.time), joint.driveForce, joint.driveForce * joint.rate};
}

double Mechanism::axisSpringForce(int index) const {
  const multibody::AxisSpring& s = model_.axisSprings()[at(index)];
  const multibody::JointReading& joint = state_.joint[at(s.joint)];
  return s.preload - s.stiffness * (joint.position - s.freePosition) - s.damping * joint.rate;
}

Mechanism::Ledger Mechanism::ledger() const {
  const multibody::Totals t = multibody::totals(model_, state_, loads_);
  return {state_.ledger.driveWork,  t.kinetic,        t.gravity,        t.elastic,
          state_.ledger.dissipated, t.linearMomentum, t.angularMomentum};
}

Mechanism::Drift Mechanism::drift() const {
  Drift drift = worst_;
  drift.velocity = solver_.velocityError(state_);
  return drift;
}

double mechanismTimeStep(const Scene& scene) {
  double fastest = 2 * base::kPi / (kStepsPerPeriod * kLongestStep); // [rad/s]
  const multibody::Model model = buildModel(scene.mechanism);
  for (const multibody::Body& b : model.bodies()) fastest = std::max(fastest, norm(b.w_WB));
  const auto inverseMass = [&](int body) {
    return body == multibody::kWorld || model.bodies()[at(body)].fixed ? 0 : 1 / model.bodies()[at(body)].mass;
  };
  for (const multibody::PointSpring& s : model.pointSprings())
    fastest = std::max(fastest, std::sqrt(s.stiffness * (inverseMass(s.bodyA) + inverseMass(s.bodyB))));
  return std::min(2 * base::kPi / (kStepsPerPeriod * fastest), scene.run.outputInterval);
}

std::vector<std::uint32_t> MechanismState::words() const {
  std::vector<std::uint32_t> words(2 * bodies.size());
  if (!bodies.empty()) std::memcpy(words.data(), bodies.data(), bodies.size() * sizeof(double));
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

} // namespace grouser::runs
