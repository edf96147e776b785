// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/simulation.hpp"

#include "base/bits.hpp"
#include "base/error.hpp"
#include "base/hash.hpp"
#include "coupling/fluid_domain.hpp"
#include "coupling/placed_on_bed.hpp"

namespace grouser::coupling {

std::string SimulationState::hash(const base::Comm& comm) const {
  base::StateHash hash;
  if (grains) hash = terrain::hashOf(*grains, comm);
  if (surfaces) hash.add(surfaces->words());
  for (const double way : lifts)
    if (way != 0) hash.add(base::bitsAs<std::uint64_t>(way));
  if (vehicle) hash.add(vehicle->words());
  for (const double number : ground.value_or(std::vector<double>{})) hash.add(base::bitsAs<std::uint64_t>(number));
  if (mechanism) hash.add(mechanism->words());
  if (fluid) {
    for (const fluid::SavedParticle& p : fluid->fluid.particles)
      for (const double number : {p.position.x, p.position.y, p.position.z, p.velocity.x, p.velocity.y, p.velocity.z,
                                  p.compression, p.acceleration.x, p.acceleration.y, p.acceleration.z})
        hash.add(base::bitsAs<std::uint64_t>(number));
    for (const double number : fluid->bodies) hash.add(base::bitsAs<std::uint64_t>(number));
  }
  Inputs set;
  set.restore(inputs);
  for (const std::uint64_t word : set.words()) hash.add(word);
  return hash.hex();
}

std::string Simulation::stateHash() const { return save().hash(comm_); }

SimulationState Simulation::save() const {
  SimulationState state;
  state.steps = steps_;
  state.settled = settled_;
  state.lifts = lifts_;
  state.ledgerAtStart = start_.counted();
  state.guard = guard_.save();
  state.taken = taken_;
  state.inputs = inputs_.save();
  if (ground_) ground_->save(state);
  if (surfaces_) state.surfaces = surfaces_->save();
  if (vehicle_) state.vehicle = vehicle_->save();
  if (mechanism_) state.mechanism = mechanism_->save();
  if (fluid_) state.fluid = fluid_->save();
  return state;
}

namespace {

LaidGround groundOf(GroundSetup& setup, const SimulationState& state, const base::Exec& exec, const base::Comm& comm) {
  if (!setup.grains || !setup.grains->isMadeOfState() || !state.grains) return buildGround(setup, exec, comm);
  if (setup.grains->bed->alone) lift(setup, state.lifts);
  return groundAt(setup, *state.grains, exec, comm);
}

} // namespace

Simulation::Simulation(SimulationSetup setup, const base::Exec& exec, const SimulationState& state,
                       const base::Comm& comm, SphereSets* spheres)
    : setup_(std::move(setup)), exec_(exec), comm_(comm), laid_(groundOf(setup_.ground, state, exec, comm)),
      settled_(state.settled), lifts_(state.lifts), gravity_(setup_.gravity), steps_(state.steps) {
  if (state.grains.has_value() != (laid_.grains != nullptr) || state.surface.empty() == hasBed() ||
      state.vehicle.has_value() != setup_.vehicle.has_value() ||
      state.mechanism.has_value() != (setup_.mechanism && !setup_.vehicle) ||
      state.fluid.has_value() != setup_.fluid.has_value() ||
      state.surfaces.has_value() != (laid_.grains && !setup_.ground.surfaces.empty()))
    throw base::InputError("the checkpoint belongs to another scene; resume with the scene that was run");
  makeActingGround();
  makeSurfaces(state.surfaces ? &*state.surfaces : nullptr);
  if (ground_) ground_->restore(state);
  makeMeshContacts(spheres);
  if (setup_.vehicle) {
    // The vehicle is assembled at its initial pose, as in an uninterrupted run, then moved.
    makeVehicle(spheres, state.vehicle->lift);
    vehicle_->restore(*state.vehicle);
  }
  if (setup_.mechanism && !setup_.vehicle) {
    if (setup_.mechanism->aboveBed && lifts_.empty())
      throw base::InputError("the checkpoint belongs to another scene; resume with the scene that was run");
    if (setup_.mechanism->aboveBed) setup_.mechanism->model.translate({0, 0, lifts_.back()});
    makeMechanism(spheres);
    mechanism_->restore(*state.mechanism);
  }
  makeFluid(state.fluid ? &*state.fluid : nullptr);
  inputs_.restore(state.inputs);
  command();
  start_.setCounted(state.ledgerAtStart);
  guard_.restore(state.guard);
  taken_ = state.taken;
}

} // namespace grouser::coupling
