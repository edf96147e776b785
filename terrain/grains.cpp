// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grains.hpp"

#include "terrain/grain_checkpoint.hpp"
#include "terrain/grain_faults.hpp"
#include "terrain/grain_kernel_data.cuh"
#include "terrain/grain_ledger.hpp"

#include <stdexcept>
#include <utility>

namespace grouser::terrain {

Grains::Grains(const base::Exec& exec, const GrainModel& model, const Boundaries& boundaries,
               const std::vector<GrainSpec>& start, const PartitionOptions& partition)
    : system_(exec, model, boundaries, start, partition), stepper_(exec) {}

contact::GrainsView Grains::view() const {
  const GrainFields& f = system_.arrays.fields();
  return {f.position.now.data(), f.motion.now.data(), f.id.now.data(), system_.arrays.slots(), system_.ghosts()};
}

void Grains::add(const std::vector<GrainSpec>& more) {
  system_.finishGhostUpdate(); // into the slots it was sent for, before the list expires
  const std::vector<base::Position> places = placesOf(more, system_.count, system_.constants);
  if (insertionOverlapAlarm_)
    if (const std::optional<InsertionOverlap> overlap = insertionOverlapOf(more, system_))
      insertionOverlapAlarm_(*overlap);
  const EnteringGrains here = system_.entering(more, places);
  system_.arrays.append(here);
  system_.count += more.size(), system_.fixedCount += fixedAmong(more);
  if (system_.distribution) system_.distribution->subdomain().appended(here.id.size());
  invalidateNeighbours();
}

bool Grains::refreshNeighbours() {
  if (listEnded_)
    rebuild();
  else if (system_.boundaries.surfacesHaveLeft())
    listNearBoundaries();
  return std::exchange(slotsChanged_, false);
}

void Grains::rebuild() {
  if (stepper_.boundariesBegun()) throw std::logic_error("cannot change slots while boundary contacts are computed");
  GrainSystem& s = system_;
  s.arrays.beginRebuild();
  if (s.distribution) s.distribution->migrate(s.arrays, s.neighbours, s.boundaries, s.steps);
  const base::Array<base::Position>& position = s.arrays.fields().position.now;
  const auto& row = s.arrays.fields().rowOrigin;
  s.neighbours.sort(position.data(), s.arrays.slots(), row.width > 0 ? row.now.data() : nullptr);
  s.arrays.permute(s.neighbours.order());
  const contact::RowOrigins* origins =
      s.distribution ? s.distribution->sorted(s.neighbours.order(), s.arrays) : nullptr;
  s.neighbours.build(position.data(), s.arrays.fields().id.now.data(), origins, s.radii());
  if (s.boundaries.any()) listNearBoundaries();
  s.arrays.endRebuild();
  stepper_.forgetGraph();
  listEnded_ = false;
  slotsChanged_ = true;
  ++s.rebuilds;
}

void Grains::listNearBoundaries() {
  system_.boundaries.list(system_.constants, system_.kernelData(), system_.arrays, system_.ghosts());
}

/// Counts the executed steps and records whether the list has expired. Throws on a fault.
void Grains::take(const StepOutcome& outcome) {
  system_.steps += outcome.taken;
  if (outcome.listEnded) listEnded_ = true;
  if (outcome.fault != kNoFault) stopFor(outcome.fault, system_);
}

void Grains::endStep() {
  take(stepper_.end(system_));
  system_.boundaries.collectSurfaceLoads(system_.comm);
  if (system_.distribution && !listEnded_) system_.distribution->sendGhosts(); // a rebuild recreates the ghosts
}

std::int64_t Grains::advance(std::int64_t most) {
  // refreshNeighbours() reports a change of slots only once: preserve it for the caller's next call.
  if (refreshNeighbours()) slotsChanged_ = true;
  if (most < GrainStepper::kStepsPerGraph || !stepper_.canBatchSteps(system_)) {
    step();
    return 1;
  }
  const StepOutcome outcome = stepper_.runBatch(system_);
  take(outcome);
  return outcome.taken;
}

void Grains::replaceLaws(const GrainModel& other) {
  GrainModel& model = system_.constants.model;
  bool alike = other.law.features() == model.law.features() && other.materials.count() == model.materials.count();
  for (std::size_t k = 0; alike && k < model.materials.grains.size(); ++k)
    alike = other.materials.grains[k].features() == model.materials.grains[k].features();
  if (!alike) throw std::logic_error("new contact laws must have the features of the first ones");
  model.law = other.law, model.materials.grains = other.materials.grains, model.gravity = other.gravity;
  system_.laws.replacePairs(system_.exec, system_.constants);
  system_.arrays.setGravityStep(model.gravity * model.timeStep);
  stepper_.forgetGraph();
}

GrainSnapshot Grains::snapshot(const SnapshotOptions& options) const {
  return GrainCheckpoint::snapshot(system_, options);
}

GrainState Grains::state() const { return GrainCheckpoint::state(system_); }

void Grains::restore(const GrainState& saved, bool grows) {
  const GrainCheckpoint checkpoint(saved, system_, grows);
  checkpoint.loadAsListed(system_);
  if (system_.distribution) system_.distribution->keepCuts(system_.steps);
  invalidateNeighbours();
  refreshNeighbours();
  slotsChanged_ = true; // callers may depend on slots
  if (!checkpoint.loadAsSaved(system_)) invalidateNeighbours();
}

SoilFields fieldsOf(Grains& grains, const FieldGrid& grid, const contact::PartMomentsView& onParts) {
  if (grains.listEnded_) throw std::logic_error("soil fields require a valid neighbour list");
  grains.system_.finishGhostUpdate();
  return measureFields(grains.system_, grid, onParts);
}

GrainLedger Grains::ledger() {
  if (listEnded_) {
    system_.arrays.holdFormer();
    rebuild();
    system_.arrays.releaseFormer();
  }
  system_.finishGhostUpdate();
  return measureLedger(system_);
}

} // namespace grouser::terrain
