// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/grains_view.hpp"
#include "terrain/grain_entry.hpp"
#include "terrain/grain_stepper.hpp"
#include "terrain/soil_fields.hpp"

namespace grouser::terrain {

/// Spheres under gravity, in contact with each other, walls, a floor and rigid parts.
///
/// The state is on the device of `exec`, sorted in space. Results do not depend on the sorting, the rebuild times, the
/// number of threads, the device, or the number of ranks and their subdomains. All members not marked `local` are
/// collective, and called in the same order on all ranks.
class Grains {
public:
  /// `start`: all grains of the scene, on every rank. Throws InputError if a grain is outside the range of the integer
  /// positions, two grains coincide, or radii differ by more than a factor of 1000.
  Grains(const base::Exec& exec, const GrainModel& model, const Boundaries& boundaries,
         const std::vector<GrainSpec>& start, const PartitionOptions& partition = {});

  std::size_t count() const { return system_.present(); } ///< grains present in the scene; local
  const GrainModel& model() const { return system_.constants.model; }
  const base::PositionScale& scale() const { return system_.constants.scale; }
  /// Read access to constants, fields, boundaries, and the last neighbour list. Local.
  const GrainSystem& system() const { return system_; }
  /// View of the grains in their current slots on the device, including ghosts, for computing loads on grains; valid
  /// until the next refresh. Local.
  contact::GrainsView view() const;
  /// Distribution of grains among ranks (migration, cuts), for modification; null on one rank. Local.
  // NOLINTNEXTLINE(readability-make-member-function-const): not available for const grains
  GrainDistribution* distribution() { return system_.distribution.get(); }

  /// Makes the neighbour list valid for the next step. Returns true if slots have changed since the last call.
  bool refreshNeighbours();
  /// Requests a rebuild at the next refresh; for tests and callers that depend on slots.
  void invalidateNeighbours() { listEnded_ = true; }

  /// Sets the poses of the surfaces for the next step, one per surface of the boundaries; the same on all ranks.
  void setSurfacePoses(const std::vector<SurfacePose>& poses) { system_.boundaries.setSurfacePoses(poses); }

  /// Adds grains between steps; their ids follow the existing ones. Throws InputError like the constructor.
  void add(const std::vector<GrainSpec>& more);
  /// Callback of add() on all ranks, before any change, if grains would overlap; must throw. Without a callback, add()
  /// does not check.
  using InsertionOverlapAlarm = std::function<void(const InsertionOverlap&)>;
  void onInsertionOverlap(InsertionOverlapAlarm alarm) { insertionOverlapAlarm_ = std::move(alarm); }

  /// Computes forces and advances one step. `loads`: loads of rigid parts; null without parts. Requires a valid list.
  /// Throws SimulationError on a fault, with step, time, grain, position and remedy.
  void step(const contact::GrainLoadsView* loads = nullptr) {
    beginStep(loads);
    endStep();
  }
  /// Launches contacts with walls and floor, concurrent with work launched before beginStep(), which waits for them.
  /// Optional: otherwise beginStep() computes them. Slots must not change in between.
  void beginBoundaries() { stepper_.beginBoundaries(system_); }
  /// Launches a step without waiting. Until endStep() the host may do any work that does not touch the grains.
  void beginStep(const contact::GrainLoadsView* loads) { stepper_.begin(system_, loads); }
  void endStep();
  /// Advances by steps without part loads, each like refreshNeighbours() and step(): at least one, at most `most`. On
  /// one GPU, or several with peer access, sixteen are launched as one CUDA graph if `most` allows; fewer are executed
  /// if a list expires. Returns the number of steps.
  std::int64_t advance(std::int64_t most);
  std::int64_t steps() const { return system_.steps; } ///< steps taken; local
  void setSteps(std::int64_t steps) { system_.steps = steps; }
  /// Replaces contact laws and gravity by those of `other` for the following steps. `other` must be a model of the same
  /// grains, with laws of the same features; otherwise throws std::logic_error.
  void replaceLaws(const GrainModel& other);
  /// Sets velocities and spins to zero.
  void stop() { system_.arrays.stop(); }

  /// Returns a snapshot; on several ranks of this rank's block of ids. Throws std::logic_error if contact forces are
  /// requested other than after a step; result rows (ledger) and entering grains are permitted in between.
  GrainSnapshot snapshot(const SnapshotOptions& options = {}) const;
  /// State for checkpoints and the state hash; on several ranks this rank's block of ids. A run resumed from
  /// `restore(state())` is bitwise identical to an uninterrupted one, on any device, for any number of ranks and any
  /// skin.
  GrainState state() const;
  /// Restores a state. Throws InputError if it belongs to other grains. `grows`: the state may have more grains than
  /// the initial scene. Set the surface poses first.
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

/// Calls measureFields(); requires neighbours refreshed since the last step.
SoilFields fieldsOf(Grains& grains, const FieldGrid& grid, const contact::PartMomentsView& onParts = {});

} // namespace grouser::terrain
