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

/// Options of the cut of a mesh for contact with bodies of `contactSize` [m] and larger.
PartCut meshCut(const SurfaceSetup& surface, double contactSize);

/// Contacts of grains with the [[mesh]]es of a scene, which are cut into spheres like the parts of a vehicle. All have
/// one material.
class MeshContacts {
public:
  /// Registers with the grains' migration, so that history follows them to other ranks; must outlive their steps.
  /// `kept`: source of sphere sets; null: all are cut.
  MeshContacts(const GroundSetup& setup, const base::Exec& exec, terrain::Grains& grains, SphereSets* kept);
  MeshContacts(const MeshContacts&) = delete;
  MeshContacts& operator=(const MeshContacts&) = delete;

  /// One step: contacts with the meshes; one motion per mesh.
  void computeContacts(const terrain::Grains& grains, const std::vector<contact::PartMotion>& motions,
                       bool slotsChanged);
  /// Returns the meshes for the complementarity solver. Call collect() after the grains' step.
  terrain::ImpulseParts parts(const terrain::Grains& grains, const std::vector<contact::PartMotion>& motions,
                              bool slotsChanged, contact::BodyResponse& response);
  /// Downloads the loads and sums them over the ranks, which all call it.
  void collect();
  /// Contact moments of the grains in the coming step; see GrainPartContacts::measure().
  contact::PartMomentsView measure(const terrain::Grains& grains, const std::vector<contact::PartMotion>& motions,
                                   bool slotsChanged);
  /// Loads for the grains' step, after computeContacts().
  const contact::GrainLoadsView* grainLoads() const { return &grainLoads_; }
  /// Loads on each mesh about its centre, summed over the ranks; valid after computeContacts() or collect().
  const std::vector<terrain::SurfaceLoad>& loads() const { return loads_; }

  contact::GrainPartContacts::Ledger ledger() const { return contacts_->ledger(); }
  std::size_t spheres() const;
  const std::vector<spheredecomp::CutReport>& cutReports() const { return cutReports_; }
  /// The meshes that overlap a grain; all ranks call it.
  std::vector<contact::GrainPartContacts::Press> pressing(std::uint32_t grain) const {
    return contacts_->pressing(grain);
  }
  std::optional<contact::GrainPartContacts::MostPressed> mostPressed() const { return contacts_->mostPressed(); }
  void resetDeepestOverlap() { contacts_->resetDeepestOverlap(); }
  /// Ids of the grains crushed to their centre in this step, of all ranks, which all call it.
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
  std::vector<spheredecomp::CutReport> cutReports_; ///< one a mesh
  std::vector<double> reach_;                       ///< radius about each frame's origin [m]
  std::unique_ptr<contact::GrainPartContacts> contacts_;
  base::Mirrored<contact::PartMotion> motion_;
  base::Mirrored<contact::PartLoad> sums_;
  base::FixedPoint force_, torque_;
  contact::GrainLoadsView grainLoads_;
  std::vector<terrain::SurfaceLoad> loads_;
  std::vector<contact::PartMotion> listedAt_; ///< empty: the lists must be built
  double room_;                               ///< travel of a mesh between two lists [m]
};

} // namespace grouser::coupling
