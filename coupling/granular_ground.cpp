// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/granular_ground.hpp"

#include "coupling/grains_under_shoes.hpp"
#include "coupling/ledger_entries.hpp"
#include "coupling/simulation_state.hpp"

#include <utility>

namespace grouser::coupling {

double GranularGround::clearance(const vehicle::Assembly& assembly) const { return liftOffGrains(assembly, grains()); }

GroundTraits GranularGround::traits() const {
  GroundTraits traits;
  traits.comm = grains().system().comm;
  traits.replicated = ReplicatedWork(grains().distribution());
  traits.smallestGrain = grains().system().constants.smallestRadius;
  traits.hasMomentum = true;
  traits.solves = grains().system().impulses != nullptr;
  return traits;
}

LoadQuanta GranularGround::meet(const PartsOnGround& parts) {
  onParts_ = std::make_unique<GrainsOnParts>(parts, *setup_.grains, grains(), exec_);
  return onParts_->quanta();
}

/// Starts walls and floor, concurrently with the part contacts. Without parts there is no concurrent work.
void GranularGround::beginUncoupled() {
  if (onParts_) grains().beginBoundaries();
}

void GranularGround::compute(const base::Exec& exec, const base::Array<contact::PartMotion>& motion, const double*,
                             contact::PartLoad* loads) {
  if (grains().system().impulses)
    solved_ = {&onParts_->contacts(), &motion, loads, nullptr};
  else
    onParts_->contacts().computeOn(exec, grains().view(), motion, loads);
}

void GranularGround::solve(contact::BodyResponse& bodies) {
  solved_.bodies = &bodies;
  grains().system().impulses->setParts(solved_);
  grains().beginStep(nullptr);
  begun_ = true;
}

/// With complementarity contacts and bodies, solve() has already begun the step.
void GranularGround::beginStep() {
  if (!std::exchange(begun_, false)) grains().beginStep(onParts_ ? &onParts_->loads() : onMeshes_);
}

void GranularGround::setGravity(const base::Vec3d& gravity) {
  terrain::GrainModel model = grains().model();
  model.gravity = gravity;
  grains().replaceLaws(model);
}

void GranularGround::addTo(Ledger& ledger) { enterGrains(ledger, grains().ledger()); }

std::vector<double> GranularGround::surfaceNow() const {
  return laid_.undisturbed ? coupling::surfaceNow(laid_, exec_) : std::vector<double>{};
}

void GranularGround::restartMeans() {
  if (onParts_) onParts_->resetDeepestOverlap();
}

void GranularGround::save(SimulationState& state) const {
  state.bed = laid_.structure;
  if (laid_.undisturbed) state.surface = laid_.undisturbed->heights();
  state.grains = grains().state();
}

void GranularGround::restore(const SimulationState& state) {
  const GrainsSetup& setup = *setup_.grains;
  if (setup.bed) {
    const GrainsSetup& alone = setup.bed->alone ? *setup.bed->alone->grains : setup;
    keepSurface(laid_, state.surface, alone.model.radius);
  }
  laid_.structure = state.bed;
  grains().restore(*state.grains, setup.isMadeOfState() || !setup.sources.empty());
  grains().setSteps(state.steps);
}

} // namespace grouser::coupling
