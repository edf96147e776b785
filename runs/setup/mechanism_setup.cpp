// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/mechanism_setup.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/setup/mechanism_model.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::setup {

namespace {

/// Steps of a period or turn that "auto" gives [-], and the longest step it gives [s].
constexpr double kStepsPerPeriod = 100, kLongestStep = 1e-3;
/// The same of swings on taut joints, few of which move much: 1 / 6.4 of the largest stable step, which leaves room for
/// forty times the tension of the start [-].
constexpr double kStepsPerTensionSwing = 20;
/// Velocities that open joints faster than this at the start were typed with a few digits, and are made to fit [m/s].
constexpr double kRoundedRate = 1e-12;

/// A mechanism at its start.
struct Start {
  explicit Start(const scene::Scene& scene)
      : setup(mechanismSetup(scene)), state(multibody::makeState(setup.model)),
        loads(multibody::makeLoads(setup.model)), solver(setup.model, setup.solver) {
    beginMotion(setup, solver, state, loads);
  }
  /// Shortest period of all springs and bushings against the masses [s]; infinite without any.
  double shortestSwing() { return 2 * base::kPi / solver.stabilityLimit() * solver.stableStep(state, loads); }
  /// The same of bodies that hang on taut joints and springs.
  double shortestTensionSwing() { return 2 * base::kPi / solver.geometricStiffnessRate(state, loads); }

  const MechanismSetup setup;
  multibody::State state;
  multibody::Loads loads;
  multibody::Solver solver;
};

double automaticTimeStep(const scene::Scene& scene) {
  Start start(scene);
  double shortest = std::min(kStepsPerPeriod * kLongestStep, start.shortestSwing());
  for (const multibody::Twist& V : start.state.twist) shortest = std::min(shortest, 2 * base::kPi / norm(V.w));
  shortest = std::min(shortest, kStepsPerPeriod / kStepsPerTensionSwing * start.shortestTensionSwing());
  // Rows fall on whole steps.
  const double row = scene.run.outputInterval;
  return row / std::ceil(kStepsPerPeriod * row / shortest);
}

} // namespace

multibody::SolverOptions solverOptions(const scene::RunSettings& run) {
  multibody::SolverOptions options;
  options.integrator = run.integrator;
  options.order = run.integratorOrder;
  options.springs = run.springs;
  options.positionTolerance = run.constraintTolerance.value_or(0);
  // Scenes say velocities with a few digits; loading has made sure that they are meant to fit.
  options.startVelocities = multibody::StartVelocities::kAccept;
  return options;
}

MechanismSetup mechanismSetup(const scene::Scene& scene) {
  MechanismSetup setup{buildModel(scene.mechanism), solverOptions(scene.run), scene.run.gravity, {}};
  for (const scene::BodySection& body : scene.mechanism.bodies) setup.boxes.push_back(body.box);
  return setup;
}

double beginMotion(const MechanismSetup& setup, multibody::Solver& solver, multibody::State& state,
                   multibody::Loads& loads) {
  loads.gravity = setup.gravity;
  const bool imposed = std::any_of(setup.model.drives().begin(), setup.model.drives().end(),
                                   [](const multibody::Drive& d) { return d.kind != multibody::DriveKind::kForce; });
  if (!imposed && solver.velocityError(state) <= kRoundedRate) return 0;
  return -solver.projectVelocities(state, loads);
}

double mechanismTimeStep(const scene::Scene& scene) {
  const double step = scene.run.timeStep ? *scene.run.timeStep : automaticTimeStep(scene);
  Start trial(scene);
  try {
    trial.solver.step(trial.state, trial.loads, step);
  } catch (const base::InputError& error) {
    scene.fail("run", "time_step", fmt::format("[s] is not possible: {}", error.what()));
  } catch (const base::SimulationError&) { // the run will say where
  }
  return step;
}

std::string tensionStepWarningAtStart(const scene::Scene& scene, double timeStep) {
  Start start(scene);
  std::string part;
  const double most =
      start.solver.stabilityLimit() / start.solver.geometricStiffnessRate(start.state, start.loads, &part);
  if (timeStep < most) return "";
  return fmt::format("{}: run.time_step = {:g} s: at the start {} bears so much that swings across it grow with steps "
                     "above {:.2g} s, after the least push; choose a shorter step, or \"auto\"",
                     scene.file.string(), timeStep, part, most);
}

} // namespace grouser::setup
