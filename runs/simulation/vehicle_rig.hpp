// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/device_graph.hpp"
#include "contact/grain_part_contacts.hpp"
#include "contact/patch_contacts.hpp"
#include "multibody/solver.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/bed.hpp"
#include "runs/simulation/step_observer.hpp"
#include "runs/simulation/vehicle_state.hpp"
#include "terrain/ground_contacts.hpp"
#include "vehicle/assembly.hpp"
#include "vehicle/driver.hpp"
#include "vehicle/observers.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace grouser::simulation {

/// The vehicle of a scene: its bodies, its surfaces, and what they touch.
class VehicleRig {
public:
  /// Reads spec and meshes, cuts the meshes into spheres, places the vehicle above the ground.
  VehicleRig(const scene::Scene& scene, const base::Exec& exec, double timeStep, const setup::Ground& ground,
             const std::function<double(double, double)>& surfaceHeight);

  // One step, in this order.
  void setSurfacePoses(); ///< poses of all parts
  void refreshLists(const terrain::Grains* grains, bool slotsChanged);
  /// All contacts of parts; the device works, the host does not wait. `observer`: told of each kind of them.
  void computeContacts(const terrain::Grains* grains, StepObserver* observer);
  void collectLoads(); ///< waits for the sums of loads
  void advance();      ///< multibody step

  /// For the grains' step; null on rigid ground.
  const contact::GrainLoadsView* grainLoads() const { return bed_ ? &grainLoads_ : nullptr; }

  const vehicle::Assembly& assembly() const { return assembly_; }
  const multibody::State& state() const { return state_; }

  /// Ground loads are means since the last restartMeans(): on grains a single step says little.
  vehicle::Observation observe() const;
  void restartMeans();
  /// A thrown or skipped track, in words; empty while all is well. Judges by the loads since it was last asked.
  std::string alarm();

  /// Energies of the contacts of parts with parts and ground, and of the bodies [J].
  struct Ledger {
    double kinetic{};       ///< of the bodies
    double driveWork{};     ///< since the start
    double potentialGain{}; ///< -(work of gravity and springs, ramps included)
    double elastic{};       ///< held in contacts now
    double dissipated{};    ///< in contacts, joints and dampers since the start
    std::int64_t patches{}; ///< of parts on parts and on ground
    std::int64_t grainContacts{};
    base::Vec3d impulseOnParts; ///< from the grains since the start [N s]
    base::Vec3d impulseOnGrains;
    base::Vec3d groundForce; ///< sum over all parts, mean since restartMeans() [N]
  };
  Ledger ledger() const;

  struct SetFigures {
    std::string mesh;
    std::size_t spheres{};
    int instances{};
  };
  /// Listed as near now: probes of parts against parts and rigid ground, and pairs of grain and part.
  std::size_t probesListed() const {
    return track_->probesListed() + (rigidGround_ ? rigidGround_->probesListed() : 0);
  }
  std::size_t grainPairsListed() const { return bed_ ? bed_->pairs() : 0; }

  const std::vector<SetFigures>& sphereSets() const { return setFigures_; }
  std::size_t totalSpheres() const;

  /// Bodies, contact history and sums, for hash and checkpoint.
  VehicleState save() const;
  /// Throws InputError when the state is of another vehicle.
  void restore(const VehicleState& state);

  /// Pose of part `i` of the assembly in the world.
  base::Pose partPose(std::size_t i) const { return vehicle::partPose(assembly_.parts[i], state_); }
  const std::vector<base::TriangleMesh>& meshes() const { return meshes_; } ///< one a part kind, see meshOfPart
  std::size_t meshOfPart(std::size_t part) const { return meshOfPart_[part]; }

private:
  // What computeContacts() is made of.
  void computeInParts(const terrain::Grains* grains, StepObserver& observer);
  void noteTravel();           ///< since the lists were made
  void uploadPoses();          ///< one small transfer; sums of loads to zero
  void computeTrackContacts(); ///< shoes against sprocket, wheels, rollers, idler
  /// Shoes and all other parts against the bed, or shoes against rigid ground.
  void computeGroundContacts(const terrain::Grains* grains, const base::Exec& exec);
  void downloadLoads(); ///< one small transfer

  void loadMeshes(const scene::Scene& scene);
  void buildContacts(const scene::Scene& scene, const setup::Ground& ground);
  contact::PartMotion motionOf(std::size_t contactPart) const;
  void sumOverRanks(contact::PartLoad* loads, std::size_t count) const;
  template <class Work> void asAllRanksDo(const Work& work);
  vehicle::GroundLoads meanGroundLoads(const std::vector<base::Vec3l>& sums, std::int64_t steps) const;
  /// Bound of how far any point of a part may have moved [m] in this step: absolute, and relative to the hull.
  void trackTravel();

  base::Exec exec_;
  base::SideStream side_;
  base::DoubleBufferedGraph contactGraph_; ///< of a step, by the buffer that holds the grains' state
  terrain::Grains* sharedGrains_{nullptr}; ///< told how long work takes that no cut can shift; null on one rank
  base::Comm comm_; ///< each rank touches its own grains; everything else is done alike on all of them
  double timeStep_;
  vehicle::Assembly assembly_;
  std::unique_ptr<multibody::Solver> solver_;
  multibody::State state_;
  multibody::Loads loads_;
  vehicle::Driver driver_;
  std::unique_ptr<vehicle::Observer> observer_;
  std::function<double(double, double)> surfaceHeight_;
  base::Vec3d gravity_;

  std::vector<base::TriangleMesh> meshes_;
  std::vector<std::size_t> meshOfPart_;
  std::vector<base::SphereSet> sets_; ///< parallel to meshes_; empty for the hull
  std::vector<SetFigures> setFigures_;
  std::vector<int> contactParts_; ///< indices into assembly_.parts of those with a surface
  std::vector<double> partReach_; ///< of each contact part about its centre of mass [m]

  contact::PatchQuanta quanta_;
  base::Mirrored<contact::PartMotion> motion_;
  base::Mirrored<double> travelled_; ///< relative and absolute travel since the lists were made [m], for the device
  base::Mirrored<contact::PartLoad> loadSums_; ///< of all contact parts: from the track, then from the ground
  std::vector<base::Vec3l> groundForceSums_;   ///< by contact part, over `meanSteps_` steps
  std::vector<base::Vec3l> alarmForceSums_;    ///< the same since the last alarm()
  std::int64_t meanSteps_{0}, alarmSteps_{0};
  base::FixedPoint groundForceQuantum_, groundTorqueQuantum_;
  std::unique_ptr<contact::PartPartContacts> track_;
  std::unique_ptr<terrain::GroundContacts> rigidGround_;
  std::unique_ptr<contact::GrainPartContacts> bed_;
  contact::GrainLoadsView grainLoads_;
  double trackMargin_{}, groundMargin_{};
  static constexpr double kNeverListed = 1e9; ///< [m] farther than any margin
  double relativeTravel_{kNeverListed}, absoluteTravel_{kNeverListed};
  base::Vec3l impulseOnParts_{};
};

} // namespace grouser::simulation
