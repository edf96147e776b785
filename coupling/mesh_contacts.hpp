// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "contact/grain_part_contacts.hpp"
#include "coupling/ground_setup.hpp"
#include "coupling/sphere_sets.hpp"
#include "terrain/grains.hpp"

#include <memory>
#include <vector>

namespace grouser::coupling {

/// Options of the sphere cut of a mesh for contact with bodies of at least `contactSize` [m].
PartCut meshCut(const SurfaceSetup& surface, double contactSize);

/// Contacts of grains with the [[mesh]]es of a scene, which are cut into spheres like the parts of a vehicle. All
/// meshes share one material.
class MeshContacts {
public:
  /// Registers with the grain migration, so that history follows the grains to other ranks; must outlive all steps of
  /// `grains`. `kept`: source of sphere sets; null: all meshes are cut.
  MeshContacts(const GroundSetup& setup, const base::Exec& exec, terrain::Grains& grains, SphereSets* kept);
  MeshContacts(const MeshContacts&) = delete;
  MeshContacts& operator=(const MeshContacts&) = delete;

  /// Computes the contacts with the meshes for one step; one motion per mesh.
  void computeContacts(const terrain::Grains& grains, const std::vector<contact::PartMotion>& motions,
                       bool slotsChanged);
  /// Returns the meshes for the complementarity solver. Call collect() after the grains' step.
  terrain::ImpulseParts parts(const terrain::Grains& grains, const std::vector<contact::PartMotion>& motions,
                              bool slotsChanged, contact::BodyResponse& response);
  /// Downloads the loads and sums them over the ranks; collective.
  void collect();
  /// Contact moments of the grains for the next step; see GrainPartContacts::measure().
  contact::PartMomentsView measure(const terrain::Grains& grains, const std::vector<contact::PartMotion>& motions,
                                   bool slotsChanged);
  /// Loads for the grain step, after computeContacts().
  const contact::GrainLoadsView* grainLoads() const { return &grainLoads_; }
  /// Loads on each mesh about its centre, summed over the ranks; valid after computeContacts() or collect().
  const std::vector<terrain::SurfaceLoad>& loads() const { return loads_; }

  contact::GrainPartContacts::Ledger ledger() const { return contacts_->ledger(); }
  std::size_t spheres() const;
  const std::vector<spheredecomp::CutReport>& cutReports() const { return cutReports_; }
  /// Meshes that overlap a grain; collective.
  std::vector<contact::GrainPartContacts::Press> pressing(std::uint32_t grain) const {
    return contacts_->pressing(grain);
  }
  std::optional<contact::GrainPartContacts::MostPressed> mostPressed() const { return contacts_->mostPressed(); }
  void resetDeepestOverlap() { contacts_->resetDeepestOverlap(); }
  /// Ids of the grains crushed to their centre in this step, over all ranks; collective.
  std::vector<std::uint32_t> endedGrains() const {
    return (sums_.host() + sets_.size())->force.x == 0 ? std::vector<std::uint32_t>{} : contacts_->ended();
  }
  void takeOut(const std::vector<std::uint32_t>& grains) { contacts_->takeOut(grains); }
  contact::SavedGrainPatches save() const { return contacts_->save(); }
  void restore(const contact::SavedGrainPatches& saved);

private:
  bool haveLeft(const std::vector<contact::PartMotion>& motions) const;
  void place(const terrain::Grains& grains, const std::vector<contact::PartMotion>& motions, bool slotsChanged);

  base::Exec exec_;
  base::Comm comm_;
  std::vector<base::SphereSet> sets_;
  std::vector<spheredecomp::CutReport> cutReports_; ///< one per mesh
  std::vector<double> reach_;                       ///< bounding radius about each frame origin [m]
  std::unique_ptr<contact::GrainPartContacts> contacts_;
  base::Mirrored<contact::PartMotion> motion_;
  base::Mirrored<contact::PartLoad> sums_;
  base::FixedPoint force_, torque_;
  contact::GrainLoadsView grainLoads_;
  std::vector<terrain::SurfaceLoad> loads_;
  std::vector<contact::PartMotion> listedAt_; ///< empty: the lists must be built
  double room_;                               ///< allowed travel of a mesh between two lists [m]
};

} // namespace grouser::coupling
