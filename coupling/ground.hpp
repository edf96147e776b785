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
  ReplicatedWork replicated;                       ///< for work that every rank does alike
  double smallestGrain = base::kInfinity;          ///< radius [m], which limits how coarsely parts are cut
  const terrain::HeightField* hullMeets = nullptr; ///< an elastic foundation for the hull, computed with the obstacles
  bool onHost = false;                             ///< contacts are computed by computeOnHost() instead of compute()
  bool deforms = false;                            ///< has fieldsNow(), and energies of its own in the ledger
  bool solves = false;                             ///< complementarity contacts: solve() computes them
  bool hasMomentum = false; ///< whether the ledger includes the momentum of the ground; true only for grains
};

/// The parts of a vehicle and of bodies as a ground meets them. What it refers to outlives the ground's steps.
struct PartsOnGround {
  const ContactParts& parts;        ///< their surfaces and contact parameters
  const vehicle::Assembly* vehicle; ///< null in scenes without a vehicle
  contact::PatchQuanta quanta;      ///< quanta of their other contacts: loads up to 1e4 times the total weight fit
  double timeStep{};                ///< [s]
  double margin{};                  ///< how far parts move at most between two calls of refreshContacts() [m]
};

/// Units of the integer sums in which a ground returns its loads on parts.
struct LoadQuanta {
  base::FixedPoint force, torque; ///< [N], [N m]
};

/// Candidates for contact.
struct ListedContacts {
  std::size_t samples{};    ///< of parts against parts and what is rigid
  std::size_t grainPairs{}; ///< of grain and part
};

/// A ground that a vehicle drives on. Derive from it to add a ground model (CONTRIBUTING.md#adding-a-ground has an
/// example). Vehicle and step loop access a ground model only through this class. SI units.
///
/// The functions stand in the order in which a simulation calls them. All ranks call all of them, in one order. A
/// ground that is not divided among ranks is computed by every rank, to the same bits.
class Ground {
public:
  Ground() = default;
  Ground(const Ground&) = delete;
  Ground& operator=(const Ground&) = delete;
  virtual ~Ground() = default;

  // Before the first step.

  /// Puts back what save() wrote, in a simulation that goes on from a saved state; before all functions below.
  /// Throws base::InputError where the state is of another ground.
  virtual void restore(const SimulationState&) {}
  /// Height of the undisturbed surface at (x, y) [m], for as long as the ground lives. The vehicle is set down on it,
  /// and sinkage is measured from it. Null where there is none.
  virtual std::function<double(double x, double y)> surface() const = 0;
  /// Called several times, always with the same result.
  virtual GroundTraits traits() const { return {}; }
  /// Extra height of the assembled vehicle above surface(), so that it starts without contact [m]. Not called when a
  /// simulation is resumed.
  virtual double clearance(const vehicle::Assembly&) const { return 0; }
  /// Takes the parts of the vehicle, once; without a vehicle this and all that concerns contacts is never called, and
  /// no memory is used for it. Returns the units of compute()'s sums.
  virtual LoadQuanta meet(const PartsOnGround& parts) = 0;
  /// Puts back the history of contacts with the parts that saveContacts() wrote.
  virtual void restoreContacts(const ContactsState&) {}

  // One step, in this order.

  /// Renews the ground's own lists where they have ended. True: refreshContacts() is due, however little parts moved.
  virtual bool refreshLists() { return false; }
  /// Lists what the parts at these places may touch until one has moved by the margin. Not in every step. `motion`:
  /// one a contact part, on the device, as in compute().
  virtual void refreshContacts(const base::Array<contact::PartMotion>&) {}
  /// Queues the ground's own work that needs no poses of the vehicle; it may run beside compute().
  virtual void beginUncoupled() {}
  /// Changes where compute() reads other memory than in the step before, as of a double buffer: work is recorded and
  /// replayed for each value. Null: always the same memory.
  virtual const void* buffer() const { return nullptr; }
  /// Queues the contacts of this step on the device, without waiting for it; recorded as a graph on a GPU, so launches
  /// must be the same in every step between two calls of refreshContacts(). Adds to loads[c] force and torque on
  /// contact part c about its centre of mass, in integers, whose sums do not depend on their order. loads[number of
  /// parts] is the ground's own. `exec`: a stream beside that of the track's contacts. `travelled`, on the device: no
  /// part has moved farther since refreshContacts() [m].
  virtual void compute(const base::Exec&, const base::Array<contact::PartMotion>&, const double* /*travelled*/,
                       contact::PartLoad* /*loads*/) {
    throw std::logic_error("a ground without onHost overrides compute()");
  }
  /// Computes the contacts of this step at once, on one thread, in the memory of the host: called instead of compute()
  /// where the traits have onHost. refreshContacts() is then not called, and every rank computes all loads.
  virtual void computeOnHost(const contact::PartMotion*, contact::PartLoad* /*loads*/) {
    throw std::logic_error("a ground with onHost overrides computeOnHost()");
  }
  /// Solves contacts and motion of the ground in this step together with the bodies. With `solves`, compute() adds no
  /// loads; solve() adds them to the same memory.
  virtual void solve(contact::BodyResponse&) { throw std::logic_error("a ground with solves overrides solve()"); }
  /// Gives the ground its own sum of compute(), over all ranks of traits().comm.
  virtual void collect(const contact::PartLoad&) {}
  /// Queues the ground's motion or change of shape under these contacts; the host then solves the vehicle beside it.
  virtual void beginStep() {}
  /// Waits for it. Throws base::SimulationError at a fault.
  virtual void endStep() {}
  /// Between two steps, where gravity is set from outside: it acts from the next one on [m/s2].
  virtual void setGravity(const base::Vec3d&) {}

  // Output. None of it changes the state.

  /// Adds energies [J] and momenta of the ground itself.
  virtual void addTo(Ledger&) {}
  /// Adds energies of the contacts with parts [J] and their number: current elastic energy, and dissipation since the
  /// start. Also called before the first step.
  virtual void addContactsTo(ContactLedger&) const {}
  virtual ListedContacts listed() const { return {}; }
  /// Heights of the surface as it lies now [m] at the nodes of the undisturbed one; empty where it does not change.
  virtual std::vector<double> surfaceNow() const { return {}; }
  /// Present surface and stresses of deformable soil; empty on other grounds.
  virtual std::optional<GroundFields> fieldsNow() const { return {}; }
  /// Begins new means and maxima: called after every row of output.
  virtual void restartMeans() {}

  // State. All on which later bits depend; hash and checkpoint are taken of it.

  /// Writes the ground's own state: grains into `grains`, another kind as plain numbers into `ground`.
  virtual void save(SimulationState&) const {}
  /// Writes the history of contacts with the parts: `ground` or `bed`; another kind may keep it in save().
  virtual void saveContacts(ContactsState&) const {}
};

} // namespace grouser::coupling
