// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/contact_parts.hpp"
#include "coupling/jointed_bodies.hpp"
#include "coupling/ledger.hpp"
#include "coupling/part_contacts.hpp"
#include "coupling/step_observer.hpp"
#include "multibody/readings.hpp"
#include "multibody/solver.hpp"
#include "multibody/state.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace grouser::coupling {

struct MechanismSetup;

/// Bodies with parts in contact with grains, ground and surfaces: those of a vehicle, or of a mechanism with shapes.
class BodiesInContact {
public:
  BodiesInContact() = default;
  BodiesInContact(const BodiesInContact&) = delete;
  BodiesInContact& operator=(const BodiesInContact&) = delete;
  virtual ~BodiesInContact() = default;

  // One step, in this order; see PartContacts.
  void setSurfacePoses() { contacts_->setPoses(state_); }
  void refreshLists(bool groundListsEnded) { contacts_->refreshLists(groundListsEnded); }
  void computeContacts(StepObserver* observer) { contacts_->compute(observer); }
  /// Sums the contact loads computed by the device; complementarity contacts follow in solveContacts().
  void collectLoads();
  /// Adds drive, towing, and applied loads of this step.
  virtual void actuate() = 0;
  /// Solves complementarity contacts with the grains, after all other loads are known. No effect for penalty contacts.
  void solveContacts();
  virtual void advance() = 0; ///< multibody step

  virtual const multibody::Model& model() const = 0;
  virtual const multibody::Solver& solver() const = 0;
  virtual multibody::Solver& stepSolver() = 0; ///< for use during a step
  const multibody::State& state() const { return state_; }
  multibody::Balance bodiesBalance() const { return multibody::balance(model(), state_, loads_); }

  /// Current state of a drive.
  struct DriveReading {
    double value = 0;  ///< imposed speed, position or torque [rad/s, rad, N m, or m/s, m, N]
    double torque = 0; ///< [N m] or [N]
    double power = 0;  ///< [W]
  };
  DriveReading drive(int index) const;
  /// Force [N] or torque [N m] of an axis spring at its current position and rate, without end stops.
  double axisSpringForce(int index) const;
  std::vector<bool> touchingBodies() const; ///< [body] true if it has a surface in contact with anything
  /// [body] total contact force, mean since the last output row [N]; zero without contacts.
  std::vector<base::Vec3d> contactForces() const { return meanForces(rowMeans_, model().bodies().size()); }
  multibody::Loads& stepLoads() { return loads_; } ///< valid between collectLoads() and advance(), for additional loads
  const PartContacts& contacts() const { return *contacts_; }
  PartContacts& stepContacts() { return *contacts_; } ///< for StepsAhead
  /// Force of the bodies on an obstacle of the scene, mean since the last output row [N].
  base::Vec3d meanForceOn(std::size_t obstacle) const;

  const std::vector<spheredecomp::CutReport>& bodyCuts() const { return bodyCuts_; } ///< sphere cuts of body meshes

protected:
  /// Adds the shapes of the bodies to the contact parts and converts their meshes to spheres; `kept` as in
  /// VehicleParts. Call it once, before the contacts are created.
  void addBodies(const MechanismSetup& setup, const multibody::Model& model, const GroundTraits& ground,
                 SphereSets* kept);

  /// Sums over steps: the force of ground and surfaces on each contact part, then the force on each surface. The sums
  /// are whole quanta, so that checkpoints are exact.
  struct ForceMeans {
    std::vector<base::Vec3l> sums;
    std::int64_t steps{0};
    void restart() { sums.assign(sums.size(), {}), steps = 0; }
  };

  /// Sums that accumulate the loads of each step; null if unused.
  virtual std::array<ForceMeans*, 3> means() = 0;
  /// [body] mean force on its parts [N].
  std::vector<base::Vec3d> meanForces(const ForceMeans& means, std::size_t bodies) const;
  /// Adds energies and momenta of the bodies and their contacts. `bodies`: its drive work includes the work of all
  /// other loads; `potential`, `elastic`: energies for the ledger [J].
  void enter(Ledger& ledger, multibody::Balance bodies, double potential, double elastic) const;

  virtual double timeStep() const = 0; ///< [s]

  multibody::State state_;
  multibody::Loads loads_;
  ReplicatedWork replicated_;             ///< for the multibody step and its impulse responses
  ForceMeans rowMeans_;                   ///< since the last output row
  std::vector<base::SphereSet> bodySets_; ///< spheres of the distinct body meshes
  std::vector<spheredecomp::CutReport> bodyCuts_;
  ContactParts contactParts_;
  std::unique_ptr<PartContacts> contacts_; ///< null if the bodies have no contacts

private:
  void addToMeans();

  std::unique_ptr<JointedBodies> jointed_; ///< null with penalty contacts
};

} // namespace grouser::coupling
