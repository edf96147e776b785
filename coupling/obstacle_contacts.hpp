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

/// Parts on what is rigid beside their feet's ground: the surfaces at rest, which all parts touch, rigid ground for the
/// hull, and the shapes of other parts (ContactParts::pairs).
class ObstacleContacts {
public:
  struct Model {
    contact::PatchQuanta quanta;
    double timeStep{};
  };
  /// `kept`: where sphere sets of meshes come from; null: they are cut. `hullOn`: rigid ground for the hull; may be
  /// null. Null where there is nothing to meet.
  static std::unique_ptr<ObstacleContacts> make(const ContactParts& parts, const std::vector<Obstacle>& obstacles,
                                                const terrain::HeightField* hullOn, const Model& model,
                                                const base::Comm& comm, SphereSets* kept);

  /// Those of the scene, in its order, and behind them the ground that the hull meets. Their motions stand behind those
  /// of the contact parts.
  std::size_t surfaces() const { return motions_.size(); }
  const std::vector<contact::PartMotion>& motions() const { return motions_; }

  /// Adds the loads of parts and surfaces; see RigidContacts::compute().
  void compute(const contact::PartMotion* motion, contact::PartLoad* loads) { contacts_->compute(motion, loads); }

  const std::vector<spheredecomp::CutReport>& cutReports() const { return cutReports_; } ///< cuts of the meshes
  contact::PatchBuffers::Ledger ledger() const { return contacts_->ledger(); }
  contact::SavedPatches save() const { return contacts_->save(); }
  void restore(const contact::SavedPatches& saved) { contacts_->restore(saved); }

private:
  ObstacleContacts() = default;

  std::vector<base::SphereSet> sets_; ///< of the meshes among them
  std::vector<spheredecomp::CutReport> cutReports_;
  std::vector<contact::PartMotion> motions_;
  std::unique_ptr<terrain::RigidContacts> contacts_;
};

/// How much higher a vehicle has to be set down so that no part stands in an obstacle [m]: 0 where none does. Throws
/// InputError, at the obstacle's place in the scene, where that would be more than 10 cm.
double liftOffObstacles(const multibody::Model& model, const ContactParts& parts,
                        const std::vector<Obstacle>& obstacles);

} // namespace grouser::coupling
