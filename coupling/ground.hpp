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

/// Constants of a ground that the vehicle's assembly depends on.
struct GroundTraits {
  base::Comm comm;                                 ///< ranks that share the ground; one: each rank has all of it
  ReplicatedWork replicated;                       ///< for work that every rank repeats
  double smallestGrain = base::kInfinity;          ///< radius [m], which limits how coarsely parts are cut
  const terrain::HeightField* hullMeets = nullptr; ///< an elastic foundation for the hull, computed with the obstacles
  bool onHost = false;                             ///< contacts are computed by computeOnHost() instead of compute()
  bool deforms = false;                            ///< has fieldsNow(), and energies of its own in the ledger
  bool solves = false;                             ///< complementarity contacts: solve() computes them
  bool hasMomentum = false; ///< whether the ledger includes the momentum of the ground; true only for grains
};

/// The parts of a vehicle and of bodies for a ground. Its references must outlive the ground's steps.
struct PartsOnGround {
  const ContactParts& parts;        ///< their surfaces and contact parameters
  const vehicle::Assembly* vehicle; ///< null in scenes without a vehicle
  contact::PatchQuanta quanta;      ///< quanta of their other contacts: loads up to 1e4 times the total weight fit
  double timeStep{};                ///< [s]
  double margin{};                  ///< largest travel of parts between two calls of refreshContacts() [m]
};

/// Units of the integer sums in which a ground returns its loads on parts.
struct LoadQuanta {
  base::FixedPoint force, torque; ///< [N], [N m]
};

/// Candidates for contact.
struct ListedContacts {
  std::size_t samples{};    ///< of parts with parts and rigid surfaces
  std::size_t grainPairs{}; ///< of grain and part
};

/// A ground that a vehicle drives on. Derive from it to add a ground model (CONTRIBUTING.md#adding-a-ground has an
/// example). Vehicle and step loop access a ground model only through this class. SI units.
///
/// The functions are listed in the order of their calls. All ranks call all of them, in the same order. A ground that
/// is not divided among ranks is computed by every rank, with the same bits.
class Ground {
public:
  Ground() = default;
  Ground(const Ground&) = delete;
  Ground& operator=(const Ground&) = delete;
  virtual ~Ground() = default;

  // Before the first step.

  /// Restores the state of save(), in a resumed simulation; before all functions below. Throws base::InputError if the
  /// state belongs to another ground.
  virtual void restore(const SimulationState&) {}
  /// Height of the undisturbed surface at (x, y) [m]; valid as long as the ground. The vehicle is placed on it, and
  /// sinkage is measured from it. Null if there is none.
  virtual std::function<double(double x, double y)> surface() const = 0;
  /// Called several times, always with the same result.
  virtual GroundTraits traits() const { return {}; }
  /// Extra height of the assembled vehicle above surface(), so that it starts without contact [m]. Not called when a
  /// simulation is resumed.
  virtual double clearance(const vehicle::Assembly&) const { return 0; }
  /// Receives the parts of the vehicle, once; without a vehicle this and the contact functions are never called, and
  /// use no memory. Returns the units of compute()'s sums.
  virtual LoadQuanta meet(const PartsOnGround& parts) = 0;
  /// Restores the history of contacts with the parts from saveContacts().
  virtual void restoreContacts(const ContactsState&) {}

  // One step, in this order.

  /// Rebuilds the ground's own lists if they have expired. True: refreshContacts() is due, however little parts moved.
  virtual bool refreshLists() { return false; }
  /// Lists the possible contacts of the parts at these poses until one has moved by the margin. Not in every step.
  /// `motion`: one per contact part, on the device, as in compute().
  virtual void refreshContacts(const base::Array<contact::PartMotion>&) {}
  /// Queues work that does not depend on vehicle poses; it may run concurrently with compute().
  virtual void beginUncoupled() {}
  /// Identifies the memory that compute() reads, such as one of two buffers: work is recorded and replayed for each
  /// value. Null: always the same memory.
  virtual const void* buffer() const { return nullptr; }
  /// Queues the contacts of this step on the device, without waiting for it; recorded as a graph on a GPU, so launches
  /// must be the same in every step between two calls of refreshContacts(). Adds to loads[c] force and torque on
  /// contact part c about its centre of mass, in integers, whose sums do not depend on their order. loads[number of
  /// parts] is the ground's own. `exec`: a stream besides that of the track's contacts. `travelled`, on the device:
  /// largest travel of a part since refreshContacts() [m].
  virtual void compute(const base::Exec&, const base::Array<contact::PartMotion>&, const double* /*travelled*/,
                       contact::PartLoad* /*loads*/) {
    throw std::logic_error("a ground without onHost must override compute()");
  }
  /// Called instead of compute() if the ground has the trait onHost. Computes the contacts of this step on one thread
  /// in host memory; refreshContacts() is then not called, and every rank computes all loads.
  virtual void computeOnHost(const contact::PartMotion*, contact::PartLoad* /*loads*/) {
    throw std::logic_error("a ground with onHost must override computeOnHost()");
  }
  /// Solves contacts and motion of the ground in this step together with the bodies. With `solves`, compute() adds no
  /// loads; solve() adds them to the same memory.
  virtual void solve(contact::BodyResponse&) { throw std::logic_error("a ground with solves must override solve()"); }
  /// Receives the ground's own sum of compute(), over all ranks of traits().comm.
  virtual void collect(const contact::PartLoad&) {}
  /// Queues the ground's motion or change of shape under these contacts; the host solves the vehicle meanwhile.
  virtual void beginStep() {}
  /// Waits for beginStep(). Throws base::SimulationError at a fault.
  virtual void endStep() {}
  /// Sets gravity for the following steps, between two steps [m/s2].
  virtual void setGravity(const base::Vec3d&) {}

  // Output. None of it changes the state.

  /// Adds energies [J] and momenta of the ground itself.
  virtual void addTo(Ledger&) {}
  /// Adds energies of the contacts with parts [J] and their number: current elastic energy, and dissipation since the
  /// start. Also called before the first step.
  virtual void addContactsTo(ContactLedger&) const {}
  virtual ListedContacts listed() const { return {}; }
  /// Present heights of the surface [m] at the nodes of the undisturbed one; empty if it does not change.
  virtual std::vector<double> surfaceNow() const { return {}; }
  /// Present surface and stresses of deformable soil; empty on other grounds.
  virtual std::optional<GroundFields> fieldsNow() const { return {}; }
  /// Restarts means and maxima: called after every row of output.
  virtual void restartMeans() {}

  // State: everything that later steps depend on, for hash and checkpoint.

  /// Writes the ground's own state: grains to `grains`, other kinds as plain numbers to `ground`.
  virtual void save(SimulationState&) const {}
  /// Writes the history of contacts with the parts: `ground` or `bed`; other kinds may write it in save().
  virtual void saveContacts(ContactsState&) const {}
};

} // namespace grouser::coupling
