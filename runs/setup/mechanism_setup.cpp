// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/mechanism_setup.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "base/rounded.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/body_mass.hpp"
#include "runs/setup/hitched_bodies.hpp"
#include "runs/setup/laws.hpp"
#include "runs/setup/mechanism_model.hpp"
#include "runs/setup/obstacles.hpp"
#include "runs/setup/time_scales.hpp"
#include "runs/setup/vehicle_surface.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <memory>

namespace grouser::setup {

namespace {

/// Steps per period or revolution for "auto" [-], and its maximum step [s].
constexpr double kStepsPerPeriod = 100, kLongestStep = 1e-3;
/// Steps per oscillation on taut joints [-]; few of these have large amplitudes. The step is 1 / 6.4 of the largest
/// stable step, so the tension may become forty times the initial tension.
constexpr double kStepsPerTensionSwing = 20;
/// Steps per bounce off an end stop (half an oscillation), as for a contact of grains [-].
constexpr double kStepsPerBounce = 20;
/// Number of steps above which a note names the spring that requires them [-].
constexpr double kManySteps = 1e6;
/// Relative tolerance of step numbers [-], since steps are printed and typed with a few digits.
constexpr double kDigits = 1e-6;

/// A mechanism at its start.
struct Start {
  explicit Start(const scene::Scene& scene)
      : setup(mechanismSetup(scene)), state(multibody::makeState(setup.model)),
        loads(multibody::makeLoads(setup.model)), solver(setup.model, setup.solver) {
    coupling::beginMotion(setup, solver, state, loads);
  }
  /// Shortest oscillation period of the masses on springs and bushings [s]; infinite without them.
  double shortestSwing(std::string* spring) {
    return 2 * base::kPi / solver.stabilityLimit() * solver.stableStep(state, loads, spring);
  }
  /// Shortest duration of a bounce off an end stop [s].
  double shortestBounce() { return base::kPi / solver.stopRate(state, loads); }
  /// Longest step at which no damper reverses a velocity [s]; infinite if all steps are allowed.
  double longestDamped(std::string* damper = nullptr) {
    if (setup.solver.integrator != multibody::Integrator::kRattle) return std::numeric_limits<double>::infinity();
    return 2 / solver.dampingRate(state, loads, damper);
  }
  /// Shortest oscillation period of bodies on taut joints and springs [s].
  double shortestTensionSwing() { return 2 * base::kPi / solver.geometricStiffnessRate(state, loads); }

  const coupling::MechanismSetup setup;
  multibody::State state;
  multibody::Loads loads;
  multibody::Solver solver;
};

/// The step of "auto", and the steps that "auto" would have without springs or without dampers [s].
struct AutomaticStep {
  double step = 0, withoutSprings = 0, withoutDampers = 0;
  double swing = 0;           ///< shortest period of the springs [s]
  double decay = 0;           ///< time constant of the strongest damper [s]
  std::string spring, damper; ///< "spring 'bar'"
};

AutomaticStep automaticStep(const scene::Scene& scene) {
  Start start(scene);
  double shortest = kStepsPerPeriod * kLongestStep;
  // Each period gets kStepsPerPeriod steps, or more if the scene requires more.
  const double ofTurns = std::min(1.0, kStepsPerPeriod / scene.run.stepsPerPeriod);
  for (const multibody::Twist& V : start.state.twist)
    shortest = std::min(shortest, ofTurns * 2 * base::kPi / norm(V.w));
  for (const TimeScale& s : timeScales(scene))
    shortest = std::min(shortest, s.time * (s.repeats ? ofTurns : kStepsPerPeriod / scene.run.stepsPerPeriod));
  shortest = std::min(shortest, kStepsPerPeriod / kStepsPerTensionSwing * start.shortestTensionSwing());
  shortest = std::min(shortest, kStepsPerPeriod / kStepsPerBounce * start.shortestBounce());
  AutomaticStep automatic;
  automatic.swing = start.shortestSwing(&automatic.spring);
  // The output interval is a whole number of steps.
  const double row = scene.run.outputInterval;
  const auto shareOfRow = [row](double time) { return row / std::ceil(kStepsPerPeriod * row / time); };
  automatic.decay = 0.5 * start.longestDamped(&automatic.damper);
  // Dampers: half the step limit, as for grains.
  const double decays = kStepsPerPeriod * automatic.decay;
  automatic.withoutSprings = shareOfRow(std::min(shortest, decays));
  automatic.withoutDampers = shareOfRow(std::min(shortest, automatic.swing));
  automatic.step = shareOfRow(std::min({shortest, automatic.swing, decays}));
  return automatic;
}

/// The output interval divided by the smallest integer for which frame interval and duration are multiples of the
/// result [s]; a thousandth of the interval if there is no such integer up to 1000.
double outputStep(const scene::RunSettings& run) {
  const auto fits = [](double time, double step) {
    const double steps = time / step;
    return std::fabs(steps - std::round(steps)) <= 1e-6;
  };
  constexpr int kMaxShares = 1000;
  int shares = 1;
  while (shares < kMaxShares &&
         !(fits(run.frameInterval, run.outputInterval / shares) && fits(run.duration, run.outputInterval / shares)))
    ++shares;
  return run.outputInterval / shares;
}

/// Throws InputError if a body initially rotates too far in a step.
void checkTurns(const scene::Scene& scene, const multibody::Model& model, const multibody::State& state, double step) {
  const double most = largestTurn(scene.run);
  for (std::size_t b = 0; b < state.twist.size(); ++b)
    if (const double rate = norm(state.twist[b].w); rate * step > most * 1.000001)
      scene.fail(
          "run", "time_step",
          fmt::format("[s] is too long for body \"{}\", which initially rotates by {:.4g} rad per step, more than "
                      "{:.4g} rad (run.steps_per_period = {:g} steps per turn); set {} s or less, or \"auto\"",
                      model.bodies()[b].name, rate * step, most, scene.run.stepsPerPeriod,
                      base::roundedDown(most / rate, 4)));
}

/// Throws InputError if a bounce off an end stop (half an oscillation) has too few steps.
void checkStops(const scene::Scene& scene, Start& start, double step) {
  std::string stop;
  const double rate = start.solver.stopRate(start.state, start.loads, &stop);
  const double bounce = base::kPi / rate, wanted = 0.5 * scene.run.stepsPerPeriod;
  if (rate == 0 || bounce / step >= wanted * (1 - kDigits)) return;
  scene.fail(
      "run", "time_step",
      fmt::format("[s] is too long for the end stops of {}: a bounce (half an oscillation) lasts {:.4g} s, {:.3g} "
                  "steps instead of {:g}, half of run.steps_per_period; set {} s or less (\"auto\": {} s), use softer "
                  "stops (stop_stiffness) or run.tolerance instead of time_step, or lower run.steps_per_period",
                  stop, bounce, bounce / step, wanted, base::roundedDown(bounce / wanted, 4),
                  base::roundedDown(automaticStep(scene).step, 4)));
}

/// Throws InputError if a damper would reverse a velocity in every step.
void checkDampers(const scene::Scene& scene, Start& start, double step) {
  if (scene.run.integratorOrder > 2) return; // here the solver itself has a lower step limit for dampers
  std::string damper;
  const double most = start.longestDamped(&damper);
  if (step <= most * (1 + kDigits)) return;
  scene.fail(
      "run", "time_step",
      fmt::format("[s] is too long for the damper of {}: its time constant is {:.3g} s, and with rattle velocities "
                  "change sign in every step longer than {} s; set this limit or less (\"auto\": {} s), use a weaker "
                  "damper, or set run.integrator = \"symplectic_euler\", which integrates dampers implicitly",
                  damper, 0.5 * most, base::roundedDown(most, 4), base::roundedDown(automaticStep(scene).step, 4)));
}

} // namespace

multibody::SolverOptions solverOptions(const scene::RunSettings& run) {
  multibody::SolverOptions options;
  options.integrator = run.integrator;
  options.order = run.integratorOrder;
  options.springs = run.springs;
  options.positionTolerance = run.constraintTolerance.value_or(0);
  options.exactGyroscopics = true;
  // Velocities in scenes have a few digits; loading has checked that they satisfy the joints.
  options.startVelocities = multibody::StartVelocities::kAccept;
  return options;
}

std::vector<std::string> shapeMaterials(const scene::Scene& scene) {
  std::vector<std::string> all;
  for (const scene::BodySection& body : scene.mechanism.bodies)
    if (!body.shapes.empty() && std::find(all.begin(), all.end(), body.material) == all.end())
      all.push_back(body.material);
  return all;
}

namespace {

/// Winkler foundations of the shapes in contact with each other, with fixed surfaces and with rigid terrain.
coupling::FoundationTable foundationsOf(const scene::Scene& scene) {
  coupling::FoundationTable table;
  table.materials = shapeMaterials(scene);
  const std::size_t ofShapes = table.materials.size();
  const auto indexOf = [&table](const std::string& material) {
    const int index = table.indexOf(material);
    if (static_cast<std::size_t>(index) == table.materials.size()) table.materials.push_back(material);
    return index;
  };
  for (const coupling::Obstacle& o : obstaclesOf(scene)) indexOf(o.surface.material);
  if (ofShapes > 0 && scene.terrain && !scene.terrain->granular()) table.ground = indexOf(scene.terrain->material);
  for (std::size_t a = 0; a < ofShapes; ++a)
    for (const std::string& b : table.materials) {
      const contact::PairProperties* pair = scene.contact(table.materials[a], b);
      table.laws.push_back(contact::mixedFoundation(scene.material(table.materials[a]), scene.material(b),
                                                    pair ? *pair : contact::PairProperties{}));
    }
  if (!scene.vehicle) return table;
  const std::optional<VehicleSurface> own = vehicleSurface(scene);
  for (std::size_t a = 0; a < ofShapes; ++a)
    table.onVehicle.push_back(own ? own->friction
                                  : pairLaw(scene, scene.vehicle->material, table.materials[a], {}).friction);
  return table;
}

/// The shapes of all bodies, in the order of the file.
std::vector<coupling::BodyShape> shapesOf(const scene::Scene& scene) {
  const std::vector<std::string> materials = shapeMaterials(scene);
  std::vector<coupling::BodyShape> all;
  for (std::size_t b = 0; b < scene.mechanism.bodies.size(); ++b) {
    const scene::BodySection& body = scene.mechanism.bodies[b];
    for (std::size_t k = 0; k < body.shapes.size(); ++k) {
      const scene::ShapeSection& s = body.shapes[k];
      const auto material = std::find(materials.begin(), materials.end(), body.material) - materials.begin();
      coupling::BodyShape& shape = all.emplace_back();
      shape = {b, poseOf(s), geometryOf(s), static_cast<int>(material), base::kInfinity, scene.placeOf("body", b)};
      if (s.loaded.query) {
        shape.key = fmt::format("body.{}.shape.{}", b, k);
        shape.mesh = std::make_shared<const coupling::BodyMesh>(
            coupling::bodyMesh(s.loaded.query, s.loaded.sphereRadius, s.sphereRadius.has_value()));
      }
      shape.largestOverlap = body.largestOverlap.value_or(coupling::kLargestOverlap * halfThickness(shape));
    }
  }
  return all;
}

} // namespace

coupling::MechanismSetup mechanismSetup(const scene::Scene& scene) {
  const std::optional<vehicle::Assembly> vehicle = vehicleOf(scene);
  coupling::MechanismSetup setup{.model = buildModel(scene.mechanism, vehicle ? &*vehicle : nullptr),
                                 .solver = solverOptions(scene.run),
                                 .gravity = scene.run.gravity,
                                 .largestTurn = largestTurn(scene.run)};
  if (vehicle) {
    setup.ofVehicle = vehicle->model.counts();
    setup.chassis = vehicle->model.bodies()[static_cast<std::size_t>(vehicle->chassis)].pose;
    setup.hitched = hitchedBodies(scene, setup.model, *vehicle);
  }
  for (const scene::BodySection& body : scene.mechanism.bodies) setup.boxes.push_back(body.box);
  setup.shapes = shapesOf(scene), setup.foundations = foundationsOf(scene);
  for (coupling::BodyShape& s : setup.shapes) s.body += setup.ofVehicle.bodies;
  for (std::size_t b = 0; b < scene.mechanism.bodies.size(); ++b)
    if (const scene::BodySection& body = scene.mechanism.bodies[b]; body.probe)
      setup.probes.push_back({setup.ofVehicle.bodies + b, *body.probe * 0.5, body.probePosition});
  if (scene.mechanism.placement) setup.aboveBed = scene.mechanism.placement->aboveBed;
  if (setup.aboveBed)
    setup.place = scene.document ? scene.document->root().section("mechanism").origin() + ": mechanism" : "mechanism";
  if (scene.run.tolerance)
    setup.control = {*scene.run.tolerance, kLongestStep, resolvingStep(timeScales(scene), scene.run.stepsPerPeriod)};
  return setup;
}

coupling::MechanismSetup contactFreeSetup(const scene::Scene& scene) {
  coupling::MechanismSetup setup = mechanismSetup(scene);
  setup.shapes.clear();
  return setup;
}

double mechanismTimeStep(const scene::Scene& scene) {
  if (scene.run.tolerance) return outputStep(scene.run);
  const double step = scene.run.timeStep ? *scene.run.timeStep : automaticStep(scene).step;
  checkTimeScales(scene, step);
  Start trial(scene);
  checkTurns(scene, trial.setup.model, trial.state, step);
  checkStops(scene, trial, step), checkDampers(scene, trial, step);
  try {
    trial.solver.step(trial.state, trial.loads, step);
  } catch (const base::InputError& error) {
    scene.fail("run", "time_step", fmt::format("[s] cannot be used: {}", error.what()));
  } catch (const base::SimulationError&) { // the run reports it
  }
  return step;
}

namespace {

/// Note on a spring with an oscillation that the given step does not resolve; this is not an error.
std::string unresolvedSpring(const scene::Scene& scene) {
  Start start(scene);
  std::string spring;
  const double swing = start.shortestSwing(&spring), steps = swing / *scene.run.timeStep;
  if (steps >= scene.run.stepsPerPeriod * (1 - kDigits)) return "";
  const bool euler = scene.run.integrator == multibody::Integrator::kSymplecticEuler;
  return fmt::format("{}: {} has a period of {:.3g} s, i.e. {:.3g} steps of run.time_step = {:g} s; {}; to resolve the "
                     "oscillation, set the step to {} s or less",
                     scene.file.string(), spring, swing, steps, *scene.run.timeStep,
                     euler ? "symplectic_euler is stable but damps the oscillation"
                     : scene.run.springs == multibody::Springs::kImplicit
                         ? "implicit springs are stable but oscillate too slowly"
                         : "explicit springs are stable but oscillate too fast",
                     base::roundedDown(swing / scene.run.stepsPerPeriod, 4));
}

/// Note on a damper that makes the step of "auto" very short.
std::string damperNote(const scene::Scene& scene, const AutomaticStep& a) {
  return fmt::format("{}: run.time_step = \"auto\" is {:.4g} s (the run takes {:.3g} steps), because the damper of {} "
                     "has a time constant of {:.3g} s; run.integrator = \"symplectic_euler\" integrates dampers "
                     "implicitly and is stable at run.time_step = {:.4g}",
                     scene.file.string(), a.step, scene.run.duration / a.step, a.damper, a.decay, a.withoutDampers);
}

} // namespace

std::string springStepNote(const scene::Scene& scene) {
  if (scene.run.tolerance) return "";
  if (scene.run.timeStep) return unresolvedSpring(scene);
  const AutomaticStep a = automaticStep(scene);
  const double steps = scene.run.duration / a.step;
  if (steps < kManySteps) return "";
  if (a.withoutDampers >= 2 * a.step) return damperNote(scene, a);
  if (a.withoutSprings < 2 * a.step) return "";
  std::string remedy;
  if (scene.run.integrator == multibody::Integrator::kSymplecticEuler)
    remedy = fmt::format("symplectic_euler integrates springs implicitly: run.time_step = {:.4g} is also stable but "
                         "damps this oscillation",
                         a.withoutSprings);
  else if (scene.run.springs == multibody::Springs::kImplicit)
    remedy =
        fmt::format("run.springs = \"implicit\" is stable at any step size: run.time_step = {:.4g} resolves everything "
                    "except this oscillation (the spring acts as a rigid link)",
                    a.withoutSprings);
  else
    remedy = fmt::format("run.springs = \"implicit\" allows run.time_step = {:.4g}, which resolves everything except "
                         "this oscillation (the spring acts as a rigid link)",
                         a.withoutSprings);
  return fmt::format(
      "{}: run.time_step = \"auto\" is {:.4g} s (the run takes {:.3g} steps), because {} has a period of {:.3g} s; {}",
      scene.file.string(), a.step, steps, a.spring, a.swing, remedy);
}

std::string tensionStepWarningAtStart(const scene::Scene& scene, double timeStep) {
  if (scene.run.tolerance) return "";
  Start start(scene);
  std::string part;
  const double most =
      start.solver.stabilityLimit() / start.solver.geometricStiffnessRate(start.state, start.loads, &part);
  if (timeStep < most) return "";
  return fmt::format("{}: run.time_step = {:g} s: the initial load on {} limits stable steps to {:.2g} s; set a "
                     "shorter step, or \"auto\"",
                     scene.file.string(), timeStep, part, most);
}

} // namespace grouser::setup
