// SPDX-License-Identifier: BSD-3-Clause
#include "runs/simulation/simulation.hpp"

#include "base/error.hpp"
#include "base/hash.hpp"
#include "runs/setup/step_limit.hpp"

namespace grouser::simulation {

std::string SimulationState::hash(const base::Comm& comm) const {
  base::StateHash hash;
  if (grains) hash = terrain::hashOf(*grains, comm);
  if (surfaces) hash.add(surfaces->words());
  if (vehicle) hash.add(vehicle->words());
  if (mechanism) hash.add(mechanism->words());
  return hash.hex();
}

std::string Simulation::stateHash() const { return save().hash(comm_); }

SimulationState Simulation::save() const {
  SimulationState state;
  state.steps = steps_;
  state.settled = settled_;
  state.energyAtStart = {start_.kinetic, start_.potential, start_.elastic, start_.dissipated};
  state.mostPutIn = mostPutIn_;
  if (ground_.undisturbed) state.surface = ground_.undisturbed->heights();
  if (ground_.grains) state.grains = ground_.grains->state();
  if (surfaces_) state.surfaces = surfaces_->save();
  if (vehicle_) state.vehicle = vehicle_->save();
  if (mechanism_) state.mechanism = mechanism_->save();
  return state;
}

Simulation::Simulation(const scene::Scene& scene, const base::Exec& exec, const SimulationState& state,
                       const base::Comm& comm)
    : scene_(scene), exec_(exec), comm_(comm), timeStep_(setup::chooseTimeStep(scene)),
      ground_(setup::buildGround(scene, exec, timeStep_, comm)), settled_(state.settled), sources_(scene, timeStep_),
      steps_(state.steps) {
  const bool bed = ground_.grains && ground_.walls;
  if (state.grains.has_value() != (ground_.grains != nullptr) || state.surface.empty() == bed ||
      state.vehicle.has_value() != scene.vehicle.has_value() ||
      state.mechanism.has_value() == scene.mechanism.empty() || state.energyAtStart.size() != 4 ||
      state.surfaces.has_value() != (ground_.grains && !setup::surfacesOf(scene).empty()))
    throw base::InputError("the checkpoint is of another scene; resume with the scene that was run");
  if (bed) setup::keepSurface(ground_, state.surface);
  surface_ = setup::surfaceHeight(ground_);
  makeSurfaces(state.surfaces ? &*state.surfaces : nullptr);
  if (ground_.grains) {
    ground_.grains->restore(*state.grains, !sources_.empty());
    ground_.grains->setSteps(steps_);
    if (surfaces_) surfaces_->makeMeshContacts(scene_, exec_, *ground_.grains);
  }
  if (scene.vehicle) {
    // The vehicle is assembled where it stood at the start, as in a run straight through; then it is moved.
    vehicle_ = std::make_unique<VehicleRig>(scene, exec, timeStep_, ground_, surface_);
    vehicle_->restore(*state.vehicle);
  }
  if (!scene.mechanism.empty()) {
    mechanism_ = std::make_unique<Mechanism>(setup::mechanismSetup(scene_), timeStep_);
    mechanism_->restore(*state.mechanism);
  }
  const std::vector<double>& e = state.energyAtStart;
  start_.kinetic = e[0], start_.potential = e[1], start_.elastic = e[2], start_.dissipated = e[3];
  mostPutIn_ = state.mostPutIn;
}

} // namespace grouser::simulation
