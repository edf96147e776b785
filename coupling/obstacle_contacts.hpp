// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/contact_parts.hpp"
#include "coupling/ground_setup.hpp"
#include "coupling/sphere_sets.hpp"
#include "multibody/model.hpp"
#include "terrain/rigid_contacts.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace grouser::coupling {

/// Throws base::SimulationError for a contact that is too deep: bodies, place, limit and remedy.
[[noreturn]] void failTooDeep(const ContactParts& parts, const terrain::RigidContacts::TooDeep& deep,
                              const std::string& surface);

/// Contacts of parts with rigid surfaces other than the ground of their feet: surfaces at rest (all parts), rigid
/// ground (hull), and the shapes of other parts (ContactParts::pairs).
class ObstacleContacts {
public:
  struct Model {
    contact::PatchQuanta quanta;
    double timeStep{};
  };
  /// Creates the contacts; null if there are none. `kept`: source of sphere sets of meshes; null: they are cut.
  /// `hullOn`: rigid ground for the hull; may be null.
  static std::unique_ptr<ObstacleContacts> make(const ContactParts& parts, const std::vector<Obstacle>& obstacles,
                                                const terrain::HeightField* hullOn, const Model& model,
                                                const base::Comm& comm, SphereSets* kept);

  /// Number of surfaces: those of the scene, in order, then the ground of the hull. Their motions follow those of the
  /// contact parts.
  std::size_t surfaces() const { return motions_.size(); }
  const std::vector<contact::PartMotion>& motions() const { return motions_; }

  /// Adds the loads of parts and surfaces; see RigidContacts::compute().
  void compute(const contact::PartMotion* motion, contact::PartLoad* loads) { contacts_->compute(motion, loads); }

  /// Throws base::SimulationError if a contact of the last step is deeper than its limit.
  void requireShallow(const ContactParts& parts) const;

  const std::vector<spheredecomp::CutReport>& cutReports() const { return cutReports_; } ///< cuts of the meshes
  contact::PatchBuffers::Ledger ledger() const { return contacts_->ledger(); }
  contact::SavedPatches save() const { return contacts_->save(); }
  void restore(const contact::SavedPatches& saved) { contacts_->restore(saved); }

private:
  ObstacleContacts() = default;

  std::vector<base::SphereSet> sets_; ///< sphere sets of the meshes among the surfaces
  std::vector<spheredecomp::CutReport> cutReports_;
  std::vector<contact::PartMotion> motions_;
  std::vector<std::string> names_; ///< names of all surfaces, also those of pairs of parts
  std::unique_ptr<terrain::RigidContacts> contacts_;
};

/// Additional lift of a vehicle so that no part overlaps an obstacle [m]; 0 if no part does. Throws InputError with the
/// obstacle's location in the scene if the lift exceeds 10 cm.
double liftOffObstacles(const multibody::Model& model, const ContactParts& parts,
                        const std::vector<Obstacle>& obstacles);

} // namespace grouser::coupling
