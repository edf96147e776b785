// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/device_graph.hpp"
#include "contact/grain_loads.hpp"
#include "contact/neighbour_list.hpp"
#include "terrain/grain_model.hpp"
#include "terrain/grain_records.hpp"
#include "terrain/grain_state.hpp"
#include "terrain/rigid_surface.hpp"
#include "terrain/subdomain.hpp"

#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace grouser::terrain {

struct GrainKernelData;
template <class Real> struct ForceData;

/// One grain as the user sets it; its id is its place in the list.
struct GrainSpec {
  base::Vec3d position; ///< [m]
  base::Vec3d velocity; ///< [m/s]
  base::Vec3d spin;     ///< [rad/s]
  double radius{0};     ///< [m], at most the model's; 0: the model's
  int material{0};      ///< among the model's
};

/// The grains of a scene on the host, by id: all of them, or on several ranks this rank's block of ids.
struct GrainSnapshot {
  std::uint64_t first{}, total{};    ///< id of the first; grains of the scene
  std::vector<base::Vec3d> position; ///< [m]
  std::vector<base::Vec3f> velocity; ///< [m/s]
  std::vector<base::Vec3f> spin;     ///< [rad/s]
  std::vector<float> radius;         ///< [m]; empty where all are the model's
};

/// Along x and y: the places [m] of two sides that are joined, where they are. What leaves through one enters through
/// the other, and grains touch across them.
using PeriodicBoundaries = std::array<std::optional<std::array<double, 2>>, 2>;

/// Rigid surroundings of the grains: plane walls, a height-field floor, and surfaces that may move; at most 32
/// together.
struct Boundaries {
  std::vector<Wall> walls;
  std::optional<HeightField> floor;
  PeriodicBoundaries joined{}; ///< walls, floor and surfaces do not know of it: they must look alike at both sides
  std::vector<RigidSurface> surfaces{};
};

/// What keeps a grain from entering: it would lie in another grain or in a surface, deeper than the model allows.
struct InsertionOverlap {
  std::size_t entering{};             ///< its place in the list of those that enter
  double overlap{};                   ///< [m]
  std::optional<std::uint32_t> grain; ///< id of the other one; none: it is a surface
  base::Vec3d position;               ///< of that grain [m]
  std::size_t surface{};              ///< or the place of that surface among those of the boundaries
};

/// Spheres under gravity, in contact with each other, with walls, a floor and rigid parts.
///
/// Of one radius and material, neither is stored with the grains. Where they differ, the radius lies in velocity.w (a
/// whole number of units of length that a float holds) and the material in spin.w.
///
/// State lives on the device of `exec`, sorted in space; results do not depend on the sorting, on when lists are
/// rebuilt, on the number of threads, on the device, or on the number of ranks and what each of them owns. On several
/// ranks all of them call every member that is not marked `local`, in the same order.
class Grains {
public:
  /// `start`: all grains of the scene, on every rank. Throws InputError when a grain lies outside the range of the
  /// integer positions, two grains coincide, or radii are too unlike for their positions' scale.
  Grains(const base::Exec& exec, const GrainModel& model, Boundaries boundaries, const std::vector<GrainSpec>& start,
         const PartitionOptions& partition = {});

  std::size_t count() const { return count_; } ///< of the scene; local
  std::size_t slots() const { return slots_; } ///< on this rank, slaves among them; local
  const GrainModel& model() const { return model_; }
  const base::PositionScale& scale() const { return scale_; }
  /// Sum of features of laws and grains, without loads; local.
  unsigned features() const { return features_; }
  bool manyRadii() const;
  const base::Period& period() const { return period_; }    ///< of periodic boundaries; local
  double smallestRadius() const { return smallestRadius_; } ///< of the scene [m]; local

  /// Where the surfaces are in the next step, one a surface of the boundaries; on all ranks the same.
  void setSurfacePoses(const std::vector<SurfacePose>& placements);
  /// What all grains put on the surfaces in the last step: order-free sums, the opposite of what the grains received.
  const std::vector<SurfaceLoad>& surfaceLoads() const { return surfaceLoads_; }
  std::int64_t surfaceListings() const { return surfaceListings_; } ///< lists of grains near boundaries made so far

  /// Makes the neighbour list valid for the next step. True when slots have changed since it was last asked.
  bool refreshNeighbours();
  /// Asks for a rebuild at the next refresh; for tests and for callers that rely on slots.
  void invalidateNeighbours() { stale_ = true; }

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
  /// Walls and floor, beside other work that the device is given before beginStep(); else they are part of that.
  void beginBoundaries();
  /// The step in two halves: the device works between them.
  void beginStep(const contact::GrainLoadsView* loads);
  void endStep();

  /// Steps of grains that nothing else acts on, each as refreshNeighbours() and step(): at least one, at most `most`.
  /// On GPUs, one or those that see each other's memory, sixteen go as one where `most` allows, without the host in
  /// between; where a list ends, fewer. Returns how many were taken.
  std::int64_t advance(std::int64_t most);

  // For those who compute loads on grains: device arrays by slot, valid until the next refresh; local.
  const base::Position* positions() const { return position_[0].data(); }
  const Vec4f* velocities() const { return velocity_[0].data(); }
  const Vec4f* spins() const { return spin_[0].data(); }
  const std::uint32_t* ids() const { return id_.data(); }
  /// Not 0 for slaves, whose loads are their master's affair; null where there are none.
  const std::uint32_t* ghosts() const { return subdomain_ ? subdomain_->ghostMarks() : nullptr; }
  /// Called when grains go to other ranks, before they do: with the rank that the grain of each slot now belongs to
  /// (device array; Subdomain::kNobody for slaves), so that those who keep history of grains can send theirs after.
  using OnMigrate = std::function<void(const std::uint32_t* destination)>;
  void onMigrate(OnMigrate onMigrate) { onMigrate_ = std::move(onMigrate); }
  /// Null on one rank.
  const Subdomain* subdomain() const { return subdomain_.get(); }
  const base::Comm& comm() const { return comm_; }
  /// Cuts that the next rebuild takes up; for tests, and for those who know better than the measured times.
  void setPartition(const Partition& partition);
  /// Time that this rank spent on work that all ranks do alike [s]: no cut can shift it.
  void noteReplicated(double seconds) { replicatedSeconds_ += seconds; }
  std::int64_t rebalancings() const { return rebalancings_; }

  GrainSnapshot snapshot() const;
  /// All of the state by id, without padding, contact history by pair of ids: equal for equal states. On several ranks
  /// those of this rank's block of ids.
  std::vector<std::uint32_t> stateWords() const;
  /// For checkpoints; on several ranks this rank's block of ids. A run that goes on from `restore(state())` gives the
  /// same bits as one that was not stopped, on any device, any number of ranks and with any skin. Throws InputError
  /// when the state is of other grains.
  GrainState state() const;
  /// `grows`: the state may hold more grains than the scene began with. Surfaces are placed beforehand.
  void restore(const GrainState& state, bool grows = false);
  GrainLedger ledger();
  /// Mean over the grains of the resultant of all forces on a grain over its weight [-], in the step that was taken
  /// last: 1 in free fall, 0 in balance. Only right after a step; 0 without gravity.
  double forceRatio() const;
  std::size_t deviceBytes() const;
  const contact::NeighbourList& neighbours() const { return neighbours_; } ///< as last built
  std::int64_t rebuilds() const { return rebuilds_; }
  std::int64_t steps() const { return steps_; }
  void setSteps(std::int64_t steps) { steps_ = steps; }
  /// Forgets velocities and spins: grains brought to rest where they are.
  void stop();

private:
  using Clock = std::chrono::steady_clock;

  /// Laws and loads in the precision of the forces; empty in the other.
  template <class Real> struct Forces {
    base::Array<contact::BasicLaw<Real>> pairs, boundaries;
    base::Array<BoundaryLoad<Real>> boundaryLoads;
  };

  GrainKernelData kernelData(const contact::GrainLoadsView* loads, int place = 0);
  template <class Real> ForceData<Real> forceData(Forces<Real>& forces);
  template <class Real> void makeForces(Forces<Real>& forces, const std::vector<contact::ContactLaw>& boundaries);
  template <class Real> void advanceUniques(Forces<Real>& forces, const contact::GrainLoadsView* loads, int place);
  void computeBoundaryContacts(const base::Exec& exec, const contact::GrainLoadsView* loads, int place);
  template <class Real> void stepWith(Forces<Real>& forces, const contact::GrainLoadsView* loads, int place);
  void launchStep(const contact::GrainLoadsView* loads, int place);
  void launchSteps();
  void swapBuffers();
  template <class Real> void advanceGrains(const base::Exec& exec, Forces<Real>& forces,
                                           const contact::GrainLoadsView* loads, int place,
                                           const base::Array<std::uint32_t>* active);
  contact::RadiiInW radii() const;
  float radiusInW(const GrainSpec& grain) const;
  void rebuild();
  void permute();
  std::optional<InsertionOverlap> insertionOverlapOf(const std::vector<GrainSpec>& entering) const; // grain_entry.cu
  void listNearBoundaries();
  // Of surfaces: grain_surfaces.cpp.
  void makeSurfaces(const Boundaries& boundaries);
  bool surfacesHaveLeft() const;
  double surfaceWay() const { return 0.5 * smallestRadius_; } ///< that they may move between two lists [m]
  void collectSurfaceLoads();
  bool canBatchSteps() const;
  int readFlags(int steps);
  [[noreturn]] void stopFor(std::uint64_t fault) const;
  GrainLayout layout() const;
  std::vector<std::uint32_t> ownSlots(const std::vector<std::uint32_t>& id) const;
  GrainState ownPlaces() const;
  GrainState ownRows() const;
  GrainState inBlocks(GrainState own) const;
  void restoreContacts(const GrainState& state, const std::vector<std::uint32_t>& id);

  // On several ranks: grain_distribution.cu.
  template <class Each> void forOwnArrays(const Each& each);
  void migrate();
  std::array<contact::ExchangeField, 3> ghostFields(int buffer);
  void finishGhostUpdate() { finishGhostUpdate(exec_); }
  void finishGhostUpdate(const base::Exec& exec);
  void updateGhosts();
  void rebalance();

  base::Exec exec_;
  GrainModel model_;
  base::PositionScale scale_;
  base::Comm comm_;
  std::size_t count_, slots_;
  double smallestRadius_;
  std::int64_t diameterUnits_, skinUnits_;
  unsigned features_;
  int historyWidth_; ///< numbers of history of a contact: 0, 3 (spring), 6 (spring, rolling angle)
  int boundaryCount_;
  base::Period period_;

  base::Array<base::Position> position_[2];
  base::Array<Vec4f> velocity_[2], spin_[2];
  base::Array<Remainders> remainders_;
  base::Array<std::uint32_t> id_;
  base::Array<base::Vec3<std::uint32_t>> reference_;
  base::Array<float> boundaryHistory_; ///< [slot][wall, floor or surface][historyWidth_]
  base::Array<std::uint32_t> boundaryContactMask_;
  base::Array<double> dissipated_;
  base::Array<Crossings> crossings_;
  base::Array<std::uint32_t> nearBoundary_, boundaryOf_;
  base::Array<double> massPerCube_;
  Forces<float> single_;
  Forces<double> double_;
  static constexpr int kStepsPerGraph = 16; ///< steps that go as one
  static_assert(kStepsPerGraph % 2 ==
                0); ///< so that the buffers, and the turns of the ghosts' exchange, end where they began
  base::Mirrored<StepFlags> flags_; ///< of each of them
  base::DoubleBufferedGraph stepGraph_;
  base::Array<Wall> walls_;
  base::Array<double> floorHeights_;
  HeightFieldView floorView_{};
  bool hasFloor_{false};

  base::Array<SurfaceGeometry> surfaces_;
  std::vector<SurfaceGeometry> geometries_;
  base::Mirrored<SurfacePose> placements_;
  std::vector<SurfacePose> listedAt_; ///< the surfaces when the grains near them were listed
  base::Mirrored<contact::PartLoad> surfaceSums_;
  base::Array<base::Vec3d> fromSurfaces_;
  base::FixedPoint surfaceForce_, surfaceTorque_;
  std::vector<SurfaceLoad> surfaceLoads_;
  std::int64_t surfaceListings_{0};

  contact::NeighbourList neighbours_;
  std::unique_ptr<Subdomain> subdomain_; ///< null on one rank
  base::SideStream side_;
  bool boundariesBegun_{false};
  OnMigrate onMigrate_;
  InsertionOverlapAlarm insertionOverlapAlarm_;
  base::Array<std::uint32_t> origin_, arrivedRows_;
  contact::RowOrigins origins_{};
  Clock::time_point measuredFrom_{Clock::now()};
  double waitedBefore_{0}, replicatedSeconds_{0};
  std::int64_t balancedAt_{0}, rebalancings_{0};

  bool stale_{true}, slotsChanged_{false};
  std::int64_t rebuilds_{0}, steps_{0};
};

} // namespace grouser::terrain
