// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/device_graph.hpp"
#include "base/gate.hpp"
#include "contact/grain_part_contacts.hpp"
#include "contact/patch_contacts.hpp"
#include "multibody/state.hpp"
#include "coupling/gear_contacts.hpp"
#include "coupling/ground.hpp"
#include "coupling/obstacle_contacts.hpp"
#include "coupling/pressed_grain.hpp"
#include "coupling/replicated_work.hpp"
#include "coupling/step_observer.hpp"
#include "coupling/vehicle_parts.hpp"
#include "coupling/vehicle_state.hpp"
#include "terrain/grains_ahead.hpp"
#include "terrain/ground_contacts.hpp"
#include "vehicle/assembly.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace grouser::coupling {

/// What the parts of a vehicle touch: shoes the running gear, all parts the grains and the surfaces at rest of the
/// scene, shoes and hull rigid ground. Computed on the device where there is one. On several ranks each computes the
/// contacts with its own grains; all else is done alike.
class VehicleContacts {
public:
  /// `assembly`, `parts` and the grains of `ground` outlive it, and it outlives the grains' steps: on several ranks it
  /// registers with their migration, as MeshContacts does.
  /// `shoesAlone`: grains meet no other part. `kept` as in VehicleParts.
  VehicleContacts(const vehicle::Assembly& assembly, const VehicleParts& parts, const GroundSetup& setup,
                  const base::Exec& exec, double timeStep, const Ground& ground, bool shoesAlone, SphereSets* kept);
  VehicleContacts(const VehicleContacts&) = delete;
  VehicleContacts& operator=(const VehicleContacts&) = delete;

  // One step, in this order.
  void setPoses(const multibody::State& state);
  void refreshLists(const terrain::Grains* grains, bool slotsChanged);
  /// Queues the contacts on the device, without waiting. `observer`: called after each kind of contacts.
  void compute(const terrain::Grains* grains, StepObserver* observer);
  /// Puts the loads, summed over all ranks, on the bodies: once the device is done with them.
  void collect(multibody::Loads& loads);
  /// How far the parts may have moved in the step that has brought them to `state`.
  void trackTravel(const multibody::State& state);

  // A step on grains that is launched ahead of its poses; see StepsAhead.
  /// Queues walls and floor, behind the gate the contacts, behind those with grains their step; tells of the loads and
  /// then of the flags of the grains.
  void launchAhead(base::Gate& gate, terrain::GrainsAhead& grains);
  /// Before the gate opens: what the device reads beside the poses.
  void noteTravel();
  /// For the poses last set; `ahead`: for those of the next step too, unless a part is thrown.
  bool listsHold(bool ahead = false) const;
  std::int64_t listings() const { return listings_; }

  /// For the grains' step; null on rigid ground.
  const contact::GrainLoadsView* grainLoads() const { return bed_ ? &grainLoads_ : nullptr; }
  bool onGround() const { return bed_ || rigidGround_; }
  /// Surfaces at rest that are to be met, and rigid ground for the hull; see ObstacleContacts.
  std::size_t surfaces() const { return obstacles_ ? obstacles_->surfaces() : 0; }
  /// Force of ground and surfaces on a contact part in the last step, in quanta of groundForceQuantum(). From the
  /// number of contact parts on: of these on the surfaces.
  base::Vec3l groundForce(std::size_t index) const;
  const base::FixedPoint& groundForceQuantum() const { return groundForceQuantum_; }

  /// What the contacts hold and have lost.
  struct Ledger {
    contact::PatchBuffers::Ledger rigid;    ///< of parts with each other and with what is rigid
    contact::GrainPartContacts::Ledger bed; ///< of parts with grains
    base::Vec3d impulseOnParts;             ///< from the grains since the start [N s]
    base::Vec3d angularOnParts; ///< about the origin of the world, from the grains since the start [N m s]
    double elastic() const { return rigid.elastic + bed.elastic; } ///< held now [J]
  };
  Ledger ledger() const;

  /// Names of the parts that press a grain, and by how much [m]; all ranks call it.
  std::vector<std::pair<std::string, double>> pressing(std::uint32_t grain) const;
  /// Grains that were crushed to their middle in this step, by id; of all ranks, which all call it.
  std::vector<std::uint32_t> endedGrains() const;
  void takeOut(const std::vector<std::uint32_t>& grains) { bed_->takeOut(grains); }
  GearContacts gearContacts() const; ///< of the last step; of all ranks, which all call it. For rows, not for steps.
  /// Since forgetPressed(); of all ranks, which all call it.
  std::optional<PressedMost> pressedMost() const;
  void forgetPressed() {
    if (bed_) bed_->forgetPressed();
  }

  /// What is listed as near now.
  struct Listed {
    std::size_t samples{};    ///< of parts against parts and what is rigid
    std::size_t grainPairs{}; ///< of grain and part
  };
  Listed listed() const;

  void save(VehicleState& state) const;
  /// Marks the lists as outdated: the next step makes them anew.
  void restore(const VehicleState& state);

private:
  friend std::vector<spheredecomp::CutReport> obstacleReports(const VehicleContacts& contacts);

  void makeTrack();
  void makeGround(const GroundSetup& setup, const Ground& ground, bool shoesAlone);
  void makeObstacles(const GroundSetup& setup, const Ground& ground, SphereSets* kept);
  contact::PartMotion motionOf(std::size_t contactPart, const multibody::State& state) const;

  // Whether parts have moved beyond what the lists hold.
  bool trackHasLeft() const;
  bool groundHasLeft() const;
  // What compute() is made of.
  void computeInParts(const terrain::Grains* grains, StepObserver& observer);
  void uploadPoses();
  void computeTrack();
  void computeObstacles();
  void computeGround(const terrain::Grains* grains, const base::Exec& exec);
  /// Of all contact parts, then of the surfaces.
  std::size_t obstacleLoads() const { return 2 * parts_.contactParts() + 1; }
  base::Vec3l inGroundQuanta(const base::Vec3l& force) const;
  void downloadLoads();

  const vehicle::Assembly& assembly_;
  const VehicleParts& parts_;
  base::Exec exec_;
  base::SideStream side_;
  base::DoubleBufferedGraph graph_; ///< of a step's contacts, by the buffer that holds the grains' state
  base::Comm comm_;
  ReplicatedWork replicated_;
  double timeStep_;

  contact::PatchQuanta quanta_;
  base::FixedPoint groundForceQuantum_, groundTorqueQuantum_;
  base::Mirrored<contact::PartMotion> motion_; ///< of the contact parts, then of the surfaces, which rest
  base::Mirrored<double> travelled_; ///< relative and absolute travel since the lists were made [m], for the device
  /// Of all contact parts: from the track, then from the ground; behind these see obstacleLoads().
  base::Mirrored<contact::PartLoad> loadSums_;
  std::unique_ptr<contact::PartPartContacts> track_;
  std::unique_ptr<terrain::GroundContacts> rigidGround_;
  std::unique_ptr<contact::GrainPartContacts> bed_;
  std::unique_ptr<ObstacleContacts> obstacles_;
  contact::GrainLoadsView grainLoads_;
  static constexpr double kNeverListed = 1e9; ///< [m] farther than any margin
  double relativeTravel_{kNeverListed}, absoluteTravel_{kNeverListed};
  double lastRelative_{0}, lastAbsolute_{0}; ///< [m] of the last step
  std::int64_t listings_{0};
  base::Vec3l impulseOnParts_{};
  base::Vec3d angularOnParts_; ///< from grains and rigid ground [N m s]
};

/// How meshes that the vehicle meets as obstacles were cut.
std::vector<spheredecomp::CutReport> obstacleReports(const VehicleContacts& contacts);

} // namespace grouser::coupling
