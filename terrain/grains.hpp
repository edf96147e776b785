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
/// rebuilt, on the number of threads, on the device, or on the number of ranks and their subdomains. All ranks call
/// every member that is not marked `local`, in the same order.
class Grains {
public:
  /// `start`: all grains of the scene, on every rank. Throws InputError when a grain lies outside the range of the
  /// integer positions, two grains coincide, or radii differ by more than a factor of 1000.
  Grains(const base::Exec& exec, const GrainModel& model, const Boundaries& boundaries,
         const std::vector<GrainSpec>& start, const PartitionOptions& partition = {});

  std::size_t count() const { return system_.present(); } ///< grains present in the scene; local
  const GrainModel& model() const { return system_.constants.model; }
  const base::PositionScale& scale() const { return system_.constants.scale; }
  /// Read access to constants, fields, boundaries, neighbours as last listed. Local.
  const GrainSystem& system() const { return system_; }
  /// The grains in their present slots on the device, ghosts among them: for code that computes loads on grains;
  /// valid until the next refresh. Local.
  contact::GrainsView view() const;
  /// Distribution of grains among ranks (migration, cuts), for modification; null on one rank. Local.
  // NOLINTNEXTLINE(readability-make-member-function-const): not available for const grains
  GrainDistribution* distribution() { return system_.distribution.get(); }

  /// Makes the neighbour list valid for the next step. True when slots have changed since the last call.
  bool refreshNeighbours();
  /// Requests a rebuild at the next refresh; for tests and callers that depend on slots.
  void invalidateNeighbours() { listEnded_ = true; }

  /// Sets the poses of the surfaces for the next step, one per surface of the boundaries; the same on all ranks.
  void setSurfacePoses(const std::vector<SurfacePose>& poses) { system_.boundaries.setSurfacePoses(poses); }

  /// Adds grains with the following ids, between steps. Throws InputError as the constructor does.
  void add(const std::vector<GrainSpec>& more);
  /// Called by add() on all ranks, before anything changes, if grains would overlap; must throw. Without it add() does
  /// not check.
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
  /// A step in two halves: launch and wait. In between the host may work on anything but the grains.
  void beginStep(const contact::GrainLoadsView* loads) { stepper_.begin(system_, loads); }
  void endStep();
  /// Takes steps without loads of parts, each as refreshNeighbours() and step(): at least one, at most `most`. On one
  /// GPU, or several with access to each other's memory, sixteen are launched as one CUDA graph if `most` allows; fewer
  /// are taken if a list expires. Returns the number of steps.
  std::int64_t advance(std::int64_t most);
  std::int64_t steps() const { return system_.steps; } ///< taken; local
  void setSteps(std::int64_t steps) { system_.steps = steps; }
  /// Replaces contact laws and gravity by those of `other` for the following steps: a model of the same grains whose
  /// laws have the same features. Throws std::logic_error otherwise.
  void replaceLaws(const GrainModel& other);
  /// Sets velocities and spins to zero.
  void stop() { system_.arrays.stop(); }

  /// On several ranks this rank's block of ids. Throws std::logic_error if contact forces are requested other than
  /// after a step; rows of results (ledger) and entering grains are allowed in between.
  GrainSnapshot snapshot(const SnapshotOptions& options = {}) const;
  /// For checkpoints and the state hash; on several ranks this rank's block of ids. A run that continues from
  /// `restore(state())` gives the same bits as an uninterrupted one, on any device, any number of ranks and with any
  /// skin.
  GrainState state() const;
  /// Throws InputError if the state belongs to other grains. `grows`: it may have more grains than the scene at the
  /// start. Surfaces must be placed before.
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
  bool listEnded_{true};     ///< the neighbour list must be rebuilt before the next step
  bool slotsChanged_{false}; ///< not yet reported by refreshNeighbours()
};

/// See measureFields(). The neighbours must have been refreshed since the last step.
SoilFields fieldsOf(Grains& grains, const FieldGrid& grid, const contact::PartMomentsView& onParts = {});

} // namespace grouser::terrain
