// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/comm.hpp"
#include "base/exec.hpp"
#include "base/fixed_point.hpp"
#include "base/math.hpp"
#include "contact/body_response.hpp"
#include "contact/part_motion.hpp"
#include "contact/patch_law.hpp"
#include "coupling/ground_fields.hpp"
#include "coupling/replicated_work.hpp"

#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

namespace grouser::terrain {
class HeightField;
}
namespace grouser::vehicle {
struct Assembly;
}

namespace grouser::coupling {

struct ContactLedger;
struct ContactParts;
struct ContactsState;
struct Ledger;
struct SimulationState;

/// Properties of a ground that the assembly of the vehicle depends on.
struct GroundTraits {
  base::Comm comm;                                  ///< ranks that share the ground; one rank: each has all of it
  ReplicatedWork replicated;                        ///< for work that every rank repeats
  double smallestGrain = base::kInfinity;           ///< radius [m]; limits the sphere radius of parts
  const terrain::HeightField* hullGround = nullptr; ///< rigid surface for the hull, computed with the obstacles
  bool onHost = false;                              ///< contacts are computed by computeOnHost() instead of compute()
  bool deforms = false;                             ///< implements fieldsNow(), and has its own energies in the ledger
  bool solves = false;                              ///< complementarity contacts: solve() computes them
  bool hasMomentum = false;                         ///< the ledger includes the momentum of the ground; only for grains
};

/// Parts of a vehicle and of bodies in contact with a ground. Its references must outlive the ground's steps.
struct PartsOnGround {
  const ContactParts& parts;        ///< their surfaces and contact parameters
  const vehicle::Assembly* vehicle; ///< null in scenes without a vehicle
  contact::PatchQuanta quanta;      ///< quanta of their other contacts, for loads up to 1e4 times the total weight
  double timeStep{};                ///< [s]
  double margin{};                  ///< maximum travel of parts between two calls of refreshContacts() [m]
};

/// Quanta of the integer sums in which a ground returns its loads on parts.
struct LoadQuanta {
  base::FixedPoint force, torque; ///< [N], [N m]
};

/// Number of contact candidates.
struct ListedContacts {
  std::size_t samples{};    ///< samples of parts near other parts and rigid surfaces
  std::size_t grainPairs{}; ///< grain-part pairs
};

/// Ground under a vehicle. Derive from it to add a ground model (CONTRIBUTING.md#adding-a-ground has an example).
/// Vehicle and step loop access a ground model only through this class. SI units.
///
/// Functions are listed in call order. All are collective and called in the same order on all ranks. If a ground is not
/// divided among ranks, every rank computes it, with identical bits.
class Ground {
public:
  Ground() = default;
  Ground(const Ground&) = delete;
  Ground& operator=(const Ground&) = delete;
  virtual ~Ground() = default;

  // Before the first step.

  /// Restores the state written by save() in a resumed simulation, before all functions below. Throws base::InputError
  /// if the state belongs to another ground.
  virtual void restore(const SimulationState&) {}
  /// Height of the undisturbed surface at (x, y) [m]; valid as long as the ground. Reference for vehicle placement and
  /// sinkage. Null if the ground has no surface.
  virtual std::function<double(double x, double y)> surface() const = 0;
  /// Called several times; must always return the same result.
  virtual GroundTraits traits() const { return {}; }
  /// Additional height of the assembled vehicle above surface() for a start without contact [m]. Not called for a
  /// resumed simulation.
  virtual double clearance(const vehicle::Assembly&) const { return 0; }
  /// Receives the contact parts, once. Without parts neither this function nor the contact functions are called, and
  /// contacts use no memory. Returns the quanta of compute()'s sums.
  virtual LoadQuanta meet(const PartsOnGround& parts) = 0;
  /// Restores the history of contacts with the parts, from saveContacts().
  virtual void restoreContacts(const ContactsState&) {}

  // One step, in this order.

  /// Rebuilds the ground's own lists if they have expired. Returns true if refreshContacts() must follow.
  virtual bool refreshLists() { return false; }
  /// Lists the candidate contacts of the parts at these poses, valid until a part has moved by the margin. Not called
  /// in every step. `motion`: one per contact part, on the device, as in compute().
  virtual void refreshContacts(const base::Array<contact::PartMotion>&) {}
  /// Enqueues work that does not depend on vehicle poses; it may run concurrently with compute().
  virtual void beginUncoupled() {}
  /// Identifies the memory read by compute(), such as one of two buffers: work is recorded and replayed for each value.
  /// Null: always the same memory.
  virtual const void* buffer() const { return nullptr; }
  /// Enqueues the contacts of this step on the device, without waiting. Recorded as a graph on a GPU, so launches must
  /// be the same in every step between two calls of refreshContacts(). Adds the force and torque on contact part c
  /// about its centre of mass to loads[c], as order-independent integer sums. loads[number of parts] belongs to the
  /// ground itself. `exec`: a stream other than that of the track contacts. `travelled`, on the device: maximum
  /// travel of a part since refreshContacts() [m].
  virtual void compute(const base::Exec&, const base::Array<contact::PartMotion>&, const double* /*travelled*/,
                       contact::PartLoad* /*loads*/) {
    throw std::logic_error("a ground without onHost must override compute()");
  }
  /// Called instead of compute() for grounds with the trait onHost. Computes the contacts of this step on one thread in
  /// host memory; refreshContacts() is then not called, and every rank computes all loads.
  virtual void computeOnHost(const contact::PartMotion*, contact::PartLoad* /*loads*/) {
    throw std::logic_error("a ground with onHost must override computeOnHost()");
  }
  /// Solves contacts and motion of the ground in this step together with the bodies. With `solves`, solve() instead of
  /// compute() adds the loads, to the same memory.
  virtual void solve(contact::BodyResponse&) { throw std::logic_error("a ground with solves must override solve()"); }
  /// Receives the ground's own load from compute(), summed over all ranks of traits().comm.
  virtual void collect(const contact::PartLoad&) {}
  /// Enqueues the motion or deformation of the ground under these contacts; the host solves the vehicle meanwhile.
  virtual void beginStep() {}
  /// Waits for beginStep(). Throws base::SimulationError on a fault.
  virtual void endStep() {}
  /// Sets gravity [m/s2] for the following steps; called between steps.
  virtual void setGravity(const base::Vec3d&) {}

  // Output. These functions must not change the state.

  /// Adds energies [J] and momenta of the ground.
  virtual void addTo(Ledger&) {}
  /// Adds energies [J] and number of the contacts with parts: current elastic energy, and dissipation since the start.
  /// Also called before the first step.
  virtual void addContactsTo(ContactLedger&) const {}
  virtual ListedContacts listed() const { return {}; }
  /// Current surface heights [m] at the nodes of the undisturbed surface; empty for an unchanging surface.
  virtual std::vector<double> surfaceNow() const { return {}; }
  /// Current surface and stresses of deformable soil; empty for other grounds.
  virtual std::optional<GroundFields> fieldsNow() const { return {}; }
  /// Restarts means and maxima; called after every output row.
  virtual void restartMeans() {}

  // State: everything that later steps depend on, for hash and checkpoint.

  /// Writes the ground's own state: grains to `grains`, other kinds of ground as an array of numbers to `ground`.
  virtual void save(SimulationState&) const {}
  /// Writes the history of contacts with the parts to `ground` or `bed`; other kinds of ground may write it in save().
  virtual void saveContacts(ContactsState&) const {}
};

} // namespace grouser::coupling
