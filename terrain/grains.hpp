// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "contact/grain_loads.hpp"
#include "contact/neighbour_list.hpp"
#include "terrain/grain_model.hpp"
#include "terrain/grain_records.hpp"
#include "terrain/grain_state.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace grouser::terrain {

struct GrainKernelData;

/// One grain as the user sets it; its id is its place in the list.
struct GrainStart {
  base::Vec3d position; ///< [m]
  base::Vec3d velocity; ///< [m/s]
  base::Vec3d spin;     ///< [rad/s]
};

/// The grains of a scene on the host, by id.
struct GrainSnapshot {
  std::vector<base::Vec3d> position; ///< [m]
  std::vector<base::Vec3f> velocity; ///< [m/s]
  std::vector<base::Vec3f> spin;     ///< [rad/s]
};

/// Rigid surroundings of the grains: plane walls and a height-field floor.
struct Boundaries {
  std::vector<Wall> walls; ///< at most 31
  std::optional<HeightField> floor;
};

/// Equal spheres under gravity, in contact with each other, with walls, a floor and rigid parts.
///
/// State lives on the device of `exec`, sorted in space; results do not depend on the sorting, on when lists are
/// rebuilt, on the number of threads or on the device.
class Grains {
public:
  /// Throws InputError when a grain lies outside the range of the integer positions or two grains coincide.
  Grains(const base::Exec& exec, const GrainModel& model, Boundaries boundaries, const std::vector<GrainStart>& start);

  std::size_t count() const { return count_; }
  const GrainModel& model() const { return model_; }
  const base::PositionScale& scale() const { return scale_; }

  /// Makes the neighbour list valid for the next step. True when it had to be rebuilt: slots have changed.
  bool refreshNeighbours();
  /// Asks for a rebuild at the next refresh; for tests and for callers that rely on slots.
  void invalidateNeighbours() { stale_ = true; }

  /// Forces and one advance. `loads` come from rigid parts; null without them. The list must be valid.
  /// Throws SimulationError at a fault, with step, time, grain, place and remedy.
  void step(const contact::GrainLoadsView* loads = nullptr) {
    beginStep(loads);
    endStep();
  }
  /// The step in two halves: the device works between them.
  void beginStep(const contact::GrainLoadsView* loads);
  void endStep();

  // For those who compute loads on grains: device arrays by slot, valid until the next refresh.
  const base::Position* positions() const { return position_[0].data(); }
  const Vec4f* velocities() const { return velocity_[0].data(); }
  const Vec4f* spins() const { return spin_[0].data(); }
  const std::uint32_t* ids() const { return id_.data(); }

  GrainSnapshot snapshot() const;
  /// All of the state by id, without padding, contact history by pair of ids: equal for equal states.
  std::vector<std::uint32_t> stateWords() const;
  /// For checkpoints. A run that goes on from `restore(state())` gives the same bits as one that was not stopped, on
  /// any device and with any skin. Throws InputError when the state is of other grains.
  GrainState state() const;
  void restore(const GrainState& state);
  GrainLedger ledger();
  std::size_t deviceBytes() const;
  const contact::NeighbourList& neighbours() const { return neighbours_; } ///< as last built
  std::int64_t rebuilds() const { return rebuilds_; }
  std::int64_t steps() const { return steps_; }
  void setSteps(std::int64_t steps) { steps_ = steps; }
  void setGravity(const base::Vec3d& gravity) { model_.gravity = gravity; }
  /// Forgets velocities and spins: a bed brought to rest between settling and driving.
  void stop();

private:
  GrainKernelData kernelData(const contact::GrainLoadsView* loads);
  void permute();
  void listNearBoundaries();
  void checkFlags();
  void restoreContacts(const GrainState& state, const std::vector<std::uint32_t>& id);

  base::Exec exec_;
  GrainModel model_;
  base::PositionScale scale_;
  std::size_t count_;
  std::int64_t diameterUnits_, skinUnits_;
  bool frictional_;
  int boundaryCount_;

  base::Array<base::Position> position_[2];
  base::Array<Vec4f> velocity_[2], spin_[2];
  base::Array<Remainders> remainders_;
  base::Array<std::uint32_t> id_;
  base::Array<base::Vec3<std::uint32_t>> reference_;
  base::Array<base::Vec3f> wallShear_;
  base::Array<std::uint32_t> wallTouching_;
  base::Array<double> dissipated_;
  base::Array<std::uint32_t> nearBoundary_, boundaryOf_;
  base::Array<BoundaryLoad> boundaryLoads_;
  base::Mirrored<StepFlags> flags_;
  base::Array<Wall> walls_;
  base::Array<double> floorHeights_;
  HeightFieldView floorView_{};
  bool hasFloor_{false};

  contact::NeighbourList neighbours_;
  bool stale_{true};
  std::int64_t rebuilds_{0}, steps_{0};
};

} // namespace grouser::terrain
