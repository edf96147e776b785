// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/device_graph.hpp"
#include "base/gate.hpp"
#include "contact/patch_contacts.hpp"
#include "coupling/contacts_state.hpp"
#include "coupling/ground.hpp"
#include "coupling/ledger_entries.hpp"
#include "coupling/obstacle_contacts.hpp"
#include "coupling/shaped_gear.hpp"
#include "coupling/step_observer.hpp"
#include "coupling/vehicle_parts.hpp"
#include "multibody/state.hpp"
#include "vehicle/assembly.hpp"

#include <memory>
#include <vector>

namespace grouser::terrain {
class GrainsAhead;
}

namespace grouser::coupling {

class GrainsOnParts;

/// Contacts of the parts of a vehicle and of bodies: shoes with the running gear, all parts with the ground and with
/// the fixed surfaces of the scene. The device, if any, computes contacts with grains and, in the samples model, gear
/// contacts. The host concurrently computes gear contacts from shapes and all contacts with rigid surfaces. Contacts
/// with a ground divided among MPI ranks are divided as well; every rank repeats all other contacts.
class PartContacts {
public:
  /// Running gear of a vehicle; its parts are the first contact parts.
  struct RunningGear {
    const vehicle::Assembly& assembly;
    const VehicleParts& parts;
  };
  /// `parts`, `gear` and `ground` must outlive this object. `gear`: running gear with contacts between its parts.
  /// `ground`: ground in contact with the parts. Both may be null. `kept` as in VehicleParts.
  PartContacts(const ContactParts& parts, const RunningGear* gear, const std::vector<Obstacle>& obstacles,
               const base::Exec& exec, double timeStep, Ground* ground, SphereSets* kept);
  PartContacts(const PartContacts&) = delete;
  PartContacts& operator=(const PartContacts&) = delete;

  // One step, in this order.
  void setPoses(const multibody::State& state);
  /// `groundListsEnded`: result of Ground::refreshLists().
  void refreshLists(bool groundListsEnded);
  /// Enqueues the contacts on the device, without waiting, and computes the host contacts. `observer`: called after
  /// each kind of contact.
  void compute(StepObserver* observer);
  /// Applies the loads, summed over all ranks, to the bodies, after the device has finished. Complementarity contacts
  /// follow in solve(). Throws base::SimulationError with the cause excessiveOverlap if a contact is too deep.
  void collect(multibody::Loads& loads);
  /// Solves complementarity contacts with the ground and adds their loads to `loads`, which contains all other loads.
  void solve(contact::BodyResponse& bodies, multibody::Loads& loads);
  bool solves() const { return traits_.solves; }
  /// Contact moments of the grains at the last poses, which the lists must cover. No side effects.
  contact::PartMomentsView measure(GrainsOnParts& onGrains, const contact::GrainsView& grains);
  /// Updates the bound on the travel of the parts after the step to `state`.
  void trackTravel(const multibody::State& state);

  // Grain step launched ahead of its poses; see StepsAhead.
  /// Enqueues walls, floor and the grains without listed parts; then, behind the gate, the part contacts and the other
  /// grains; then copies of the loads and of the grain flags to the host.
  void launchAhead(base::Gate& gate, terrain::GrainsAhead& grains, GrainsOnParts& onGrains);
  /// Call before the gate opens: sets the data read by the device in addition to the poses.
  void noteTravel();
  /// Call after the gate opens: computes the host contacts.
  void computeOnHost();
  /// True if the lists are valid for the current poses; `ahead`: also for those of the next step, unless a part is
  /// thrown off.
  bool listsAreValid(bool ahead = false) const;
  double lastTravel() const { return lastAbsolute_; } ///< upper bound of the travel of surface points in the last step
  std::int64_t listings() const { return listings_; }

  bool onGround() const { return ground_ != nullptr; }
  /// Number of surfaces at rest, including rigid ground for the hull; see ObstacleContacts.
  std::size_t surfaces() const { return obstacles_ ? obstacles_->surfaces() : 0; }
  /// Force of ground and surfaces on a contact part in the last step, in quanta of groundForceQuantum(). Indices beyond
  /// the contact parts: force of the parts on the surfaces.
  base::Vec3l groundForce(std::size_t index) const;
  const base::FixedPoint& groundForceQuantum() const { return groundQuanta_.force; }

  ContactLedger ledger() const;
  ListedContacts listed() const; ///< current candidates

  void save(ContactsState& state) const;
  /// Restores the state and marks the lists as outdated: the next step rebuilds them.
  void restore(const ContactsState& state);

private:
  friend std::vector<spheredecomp::CutReport> obstacleReports(const PartContacts& contacts);

  void makeTrack();
  void sumGroundLoads();
  void addGroundLoad(std::size_t part, multibody::Wrench& wrench);
  void makeObstacles(const std::vector<Obstacle>& obstacles, SphereSets* kept);

  // True if parts have moved beyond the margin of the lists.
  bool trackHasLeft() const;
  bool groundHasLeft() const;
  // Stages of compute().
  void computeInParts(StepObserver& observer);
  void uploadPoses();
  void computeTrack();
  void computeGear();
  void computeGround(const base::Exec& exec);
  void computeRigid();
  bool usesDevice() const { return track_ || (ground_ && !traits_.onHost); }
  base::Vec3l inGroundQuanta(const base::Vec3l& force) const;
  void downloadLoads();
  contact::PartLoad* groundLoads(); ///< loads on all contact parts, and the ground's own

  const ContactParts& parts_;
  const RunningGear* running_; ///< null in scenes without a vehicle
  base::Exec exec_;
  base::SideStream side_;
  base::DoubleBufferedGraph graph_; ///< graph of a step's contacts, for each buffer of the ground
  Ground* ground_;                  ///< null: no contact with ground
  GroundTraits traits_;
  double timeStep_;

  contact::PatchQuanta quanta_;
  LoadQuanta groundQuanta_;
  base::Mirrored<contact::PartMotion> motion_; ///< motions of the contact parts, then of the surfaces at rest
  base::Mirrored<double> travelled_; ///< relative and absolute travel since the lists were built [m], for the device
  /// Loads from the device: gear loads of all contact parts, then their ground loads, then the ground's own load.
  base::Mirrored<contact::PartLoad> loadSums_;
  // Loads from the host.
  std::vector<contact::PartLoad> gearLoads_;         ///< [contact part] from shapes
  std::vector<contact::PartLoad> groundLoads_;       ///< [contact part], then the load on the ground
  std::vector<contact::PartLoad> surfaceLoads_;      ///< [contact part], then [surface]
  std::unique_ptr<contact::PartPartContacts> track_; ///< contacts by samples; null if `gear_` has shapes
  std::unique_ptr<ShapedGear> gear_;
  std::unique_ptr<ObstacleContacts> obstacles_;
  static constexpr double kNeverListed = 1e9; ///< [m] larger than any margin
  double relativeTravel_{kNeverListed}, absoluteTravel_{kNeverListed};
  double lastRelative_{0}, lastAbsolute_{0}; ///< [m] travel in the last step
  std::int64_t listings_{0};
  base::Vec3l impulseOnParts_{};
  base::Vec3d angularOnParts_; ///< angular impulse from the ground [N m s]
};

/// Cuts of the meshes among the vehicle's obstacles.
std::vector<spheredecomp::CutReport> obstacleReports(const PartContacts& contacts);

} // namespace grouser::coupling
