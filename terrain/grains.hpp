// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/grains_view.hpp"
#include "terrain/grain_entry.hpp"
#include "terrain/grain_stepper.hpp"
#include "terrain/soil_fields.hpp"

namespace grouser::terrain {

/// Spheres under gravity, in contact with each other, with walls, a floor and rigid parts.
///
/// State lives on the device of `exec`, sorted in space; results do not depend on the sorting, on when lists are
/// rebuilt, on the number of threads, on the device, or on the number of ranks and what each of them owns. On several
/// ranks all of them call every member that is not marked `local`, in the same order.
class Grains {
public:
  /// `start`: all grains of the scene, on every rank. Throws InputError when a grain lies outside the range of the
  /// integer positions, two grains coincide, or radii are too unlike for their positions' scale.
  Grains(const base::Exec& exec, const GrainModel& model, const Boundaries& boundaries,
         const std::vector<GrainSpec>& start, const PartitionOptions& partition = {});

  std::size_t count() const { return system_.present(); } ///< of the scene, that are there; local
  const GrainModel& model() const { return system_.constants.model; }
  const base::PositionScale& scale() const { return system_.constants.scale; }
  /// What the grains consist of, to read: constants, fields, boundaries, neighbours as last listed. Local.
  const GrainSystem& system() const { return system_; }
  /// The grains in their present slots on the device, ghosts among them: for code that computes loads on grains;
  /// valid until the next refresh. Local.
  contact::GrainsView view() const;
  /// Migration and cuts, to change them; null on one rank. Local.
  // NOLINTNEXTLINE(readability-make-member-function-const): who may only look at grains shall not get it
  GrainDistribution* distribution() { return system_.distribution.get(); }

  /// Makes the neighbour list valid for the next step. True when slots have changed since the last call.
  bool refreshNeighbours();
  /// Asks for a rebuild at the next refresh; for tests and for callers that rely on slots.
  void invalidateNeighbours() { listEnded_ = true; }

  /// Where the surfaces are in the next step, one a surface of the boundaries; on all ranks the same.
  void setSurfacePoses(const std::vector<SurfacePose>& poses) { system_.boundaries.setSurfacePoses(poses); }

  /// More grains, with the ids that follow; between steps. Throws InputError as the constructor does.
  void add(const std::vector<GrainSpec>& more);
  /// Called by add() on all ranks, before anything has changed, where there is no room; must throw. Without it add()
  /// does not look.
  using InsertionOverlapAlarm = std::function<void(const InsertionOverlap&)>;
  void onInsertionOverlap(InsertionOverlapAlarm alarm) { insertionOverlapAlarm_ = std::move(alarm); }

  /// Forces and one advance. `loads` come from rigid parts; null without them. The list must be valid.
  /// Throws SimulationError at a fault, with step, time, grain, place and remedy.
  void step(const contact::GrainLoadsView* loads = nullptr) {
    beginStep(loads);
    endStep();
  }
  /// Launches contacts with walls and floor, to run beside whatever is launched before beginStep(), which waits for
  /// them; without this call beginStep() computes them. Slots must not change in between.
  void beginBoundaries() { stepper_.beginBoundaries(system_); }
  /// The step in two halves: launch, and wait. In between the host may work on anything but the grains.
  void beginStep(const contact::GrainLoadsView* loads) { stepper_.begin(system_, loads); }
  void endStep();
  /// Steps of grains that nothing else acts on, each as refreshNeighbours() and step(): at least one, at most `most`.
  /// On GPUs, one or those that see each other's memory, sixteen are launched as one CUDA graph where `most` allows;
  /// where a list ends, fewer are taken. Returns how many were taken.
  std::int64_t advance(std::int64_t most);
  std::int64_t steps() const { return system_.steps; } ///< taken; local
  void setSteps(std::int64_t steps) { system_.steps = steps; }
  /// From the next step on grains touch each other with the laws of `other`, and fall with its gravity: a model of the
  /// same grains whose laws have the same features. Throws std::logic_error where they have not.
  void replaceLaws(const GrainModel& other);
  /// Forgets velocities and spins: grains brought to rest where they are.
  void stop() { system_.arrays.stop(); }

  /// On several ranks this rank's block of ids. Throws std::logic_error where contact forces are asked for when
  /// something else than a step came last; rows of results (ledger) and grains that enter do no harm.
  GrainSnapshot snapshot(const SnapshotOptions& options = {}) const;
  /// For checkpoints and the state hash; on several ranks this rank's block of ids. A run that goes on from
  /// `restore(state())` gives the same bits as one that was not stopped, on any device, any number of ranks and with
  /// any skin.
  GrainState state() const;
  /// Throws InputError when the state is of other grains. `grows`: it may hold more than the scene began with. Surfaces
  /// are placed beforehand.
  void restore(const GrainState& state, bool grows = false);
  GrainLedger ledger();

private:
  friend class GrainsAhead;
  friend SoilFields fieldsOf(Grains& grains, const FieldGrid& grid, const contact::PartMomentsView& onParts);
  void rebuild();
  void listNearBoundaries();
  void take(const StepOutcome& outcome);

  GrainSystem system_;
  GrainStepper stepper_;
  InsertionOverlapAlarm insertionOverlapAlarm_;
  bool listEnded_{true};     ///< the neighbour list must be made anew before the next step
  bool slotsChanged_{false}; ///< and refreshNeighbours() has not said so yet
};

/// See measureFields(). The neighbours must have been refreshed since the last step.
SoilFields fieldsOf(Grains& grains, const FieldGrid& grid, const contact::PartMomentsView& onParts = {});

} // namespace grouser::terrain
