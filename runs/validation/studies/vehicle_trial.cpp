// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/vehicle_trial.hpp"

#include "base/error.hpp"
#include "coupling/simulation.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/setup/time_scales.hpp"
#include "runs/support/locations.hpp"
#include "runs/support/text_file.hpp"
#include "vehicle/pin_reactions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace grouser::studies {

namespace fs = std::filesystem;

namespace {

constexpr int kSamples = 100; // number of samples in the window

/// Text of the vehicle file light_tracked.toml with changed values.
std::string specText(const std::vector<SpecChange>& changes) {
  const fs::path assets = support::shareFolder() / "assets", file = assets / "vehicles" / "light_tracked.toml";
  std::ifstream in(file);
  std::ostringstream read;
  read << in.rdbuf();
  std::string text = read.str();
  const auto change = [&](const SpecChange& c) {
    const std::size_t section = text.find("\n[" + c.section + "]\n");
    const std::size_t line = section == std::string::npos ? section : text.find("\n" + c.key + " = ", section);
    if (line == std::string::npos)
      throw std::logic_error(fmt::format("{}: has no {}.{}", file.string(), c.section, c.key));
    text.replace(line + 1, text.find('\n', line + 1) - line - 1, c.key + " = " + c.value);
  };
  change({"vehicle", "mesh_folder", fmt::format("\"{}\"", (assets / "meshes").string())});
  for (const SpecChange& c : changes) change(c);
  return text;
}

/// Reads the scene of a case at a step; `step` = 0: automatic step.
scene::Scene parsed(const VehicleCase& what, double step, const fs::path& folder) {
  fs::create_directories(folder);
  std::string text = sceneText(what, step);
  if (!what.ownVehicle) {
    const fs::path spec = folder / "vehicle.toml";
    support::writeTextFile(spec, specText(what.changes), "--out");
    text += fmt::format("spec = \"{}\"\n", fs::absolute(spec).string());
  }
  return setup::parseScene(text, folder / "scene.toml");
}

/// Mean tension of all pin joints in the last step [N].
double pinTension(const coupling::Simulation& run) {
  const coupling::VehicleRig& rig = *run.vehicle();
  double sum = 0, pins = 0;
  for (int track = 0; track < static_cast<int>(rig.assembly().tracks.size()); ++track)
    for (const vehicle::PinReaction& pin : vehicle::pinReactions(rig.assembly(), track, rig.state(), run.timeStep()))
      sum += pin.tension, ++pins;
  return sum / pins;
}

/// Sums over the samples in the window. The tension is summed over all steps, because impacts of rigid links last a
/// single step, and samples would miss their impulse.
class Window {
public:
  void step(const coupling::Simulation& run) { pull_ += pinTension(run), ++steps_; }
  void take(const coupling::Simulation& run) {
    const coupling::VehicleRig& rig = *run.vehicle();
    const vehicle::Observation now = rig.observe();
    ++samples_;
    sums_.speed += now.velocity.x, sums_.speedMagnitude += std::fabs(now.velocity.x), sums_.pitch += now.pitchAngle;
    sums_.height += rig.state().pose[static_cast<std::size_t>(rig.assembly().chassis)].position.z;
    double sunk = 0, shoes = 0, power = 0;
    for (const vehicle::TrackObservation& track : now.tracks) power += track.drivePower;
    sums_.powerMagnitude += std::fabs(power);
    for (const vehicle::TrackObservation& track : now.tracks)
      for (std::size_t i = 0; i < track.sinkage.size(); ++i)
        if (track.onGround[i] > 0 && std::isfinite(track.sinkage[i])) sunk += track.sinkage[i], ++shoes;
    if (shoes > 0) sums_.sinkage += sunk / shoes, ++sunken_;
  }
  void means(MapFigures& f) const {
    if (samples_ == 0) return;
    f.speed = sums_.speed / samples_, f.height = sums_.height / samples_, f.pitch = sums_.pitch / samples_;
    f.speedMagnitude = sums_.speedMagnitude / samples_, f.powerMagnitude = sums_.powerMagnitude / samples_;
    f.tension = pull_ / steps_;
    if (sunken_ > 0) f.sinkage = sums_.sinkage / sunken_;
  }

private:
  MapFigures sums_{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  double samples_ = 0, sunken_ = 0, pull_ = 0, steps_ = 0;
};

/// Runs to the end of the window, or until a guard stops it.
void drive(coupling::Simulation& run, const VehicleCase& what, VehicleTrial& trial) {
  const auto stepOf = [&run](double time) { return static_cast<std::int64_t>(std::llround(time / run.timeStep())); };
  const std::int64_t begin = stepOf(what.from), end = std::max(begin + 1, stepOf(what.until));
  const std::size_t chassis = static_cast<std::size_t>(run.vehicle()->assembly().chassis);
  Window window;
  double workBefore = 0, began = 0;
  std::int64_t sample = 0;
  MapFigures& f = trial.figures;
  f.lowest = INFINITY;
  const auto note = [&] {
    trial.reached = run.time();
    window.means(f);
    const coupling::Ledger ledger = run.ledger();
    f.dissipated = ledger.dissipated.total(), f.integrationError = ledger.integrationError,
    f.turnover = ledger.turnover;
    f.energyResidual = ledger.turnover > 0 ? ledger.residual / ledger.turnover : 0;
    f.blow = run.vehicle()->observe().blows.most;
    if (run.steps() > begin) f.power = (ledger.driveWork - workBefore) / (run.time() - began);
  };
  try {
    while (run.steps() < end) {
      if (run.steps() == begin) workBefore = run.ledger().driveWork, began = run.time(), run.restartMeans();
      run.step();
      if (run.steps() > begin) window.step(run);
      f.lowest = std::min(f.lowest, run.vehicle()->state().pose[chassis].position.z);
      if (run.steps() % 256 == 0) jobs::stopStudyOnRequest();
      // The samples are evenly spaced at any step.
      if (run.steps() > begin && (run.steps() - begin) * kSamples >= (sample + 1) * (end - begin)) {
        ++sample;
        window.take(run);
        run.restartMeans();
      }
    }
    run.checkEnergy();
  } catch (const base::SimulationError&) {
    note();
    throw;
  }
  note();
}

} // namespace

std::string sceneText(const VehicleCase& what, double step) {
  std::string text = fmt::format("version = 1\n[run]\nduration = {:.17g}\n{}", what.until, what.run);
  if (step > 0) text += fmt::format("time_step = {:.17g}\n", step);
  return text + what.scene;
}

scene::Scene sceneOf(const VehicleCase& what, double step, const fs::path& folder, StepCheck check) {
  return parsed(what, check == StepCheck::none ? 0 : step, folder);
}

double longestStep(const VehicleCase& what, const fs::path& folder) {
  const scene::Scene scene = parsed(what, 0, folder);
  return std::min(setup::stepLimit(scene).step,
                  setup::resolvingStep(setup::timeScales(scene), scene.run.stepsPerPeriod));
}

VehicleTrial tryVehicle(const VehicleCase& what, double step, const TrialPlace& place, StepCheck check) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  VehicleTrial trial;
  trial.step = step;
  try {
    const scene::Scene scene = sceneOf(what, step, place.folder, check);
    coupling::SimulationSetup setup = setup::simulationSetup(scene);
    if (check == StepCheck::none) setup.timeStep = step, setup.ground = setup::groundSetup(scene, step);
    coupling::Simulation run(
        std::move(setup), place.exec, [](double, double) { jobs::stopStudyOnRequest(); }, {}, place.beds,
        place.spheres);
    drive(run, what, trial);
  } catch (const base::InputError& error) {
    trial.end = TrialEnd::refused, trial.cause = error.what();
  } catch (const base::SimulationError& error) {
    trial.end = TrialEnd::stopped, trial.cause = error.what(), trial.blamed = error.cause();
  }
  trial.wallSeconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return trial;
}

} // namespace grouser::studies
