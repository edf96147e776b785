// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/mesh_contacts.hpp"

#include "coupling/grain_part_model.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace grouser::coupling {

using base::Vec3d;

PartCut meshCut(const SurfaceSetup& surface, double contactSize) {
  constexpr double kPermitted = 0.02; // protrusion and dip [contact size]
  PartCut cut{
      &surface.mesh->mesh(),           surface.name, {}, {}, fmt::format("mesh.{}.sphere_radius", surface.number),
      surface.place + ".sphere_radius"};
  const double size = contactSize / surface.sphereRefinement;
  cut.options.radius = surface.sphereRadius / surface.sphereRefinement, cut.options.interior = false;
  cut.limit = {kPermitted * size, size, kPermitted * size, !surface.sphereRadiusGiven};
  return cut;
}

MeshContacts::MeshContacts(const GroundSetup& setup, const base::Exec& exec, terrain::Grains& grains, SphereSets* kept)
    : exec_(exec), comm_(grains.system().comm), room_(0.5 * grains.system().constants.smallestRadius) {
  std::vector<contact::GrainPart> parts;
  std::vector<PartCut> cuts;
  for (const SurfaceSetup& surface : setup.surfaces) {
    if (!surface.mesh) continue;
    parts.push_back({static_cast<int>(cuts.size()), {}, {}});
    cuts.push_back(meshCut(surface, grains.system().constants.smallestRadius));
  }
  sets_ = cutParts(cuts, kept, comm_, &cutReports_);
  std::vector<const base::SphereSet*> sets;
  for (const base::SphereSet& set : sets_) {
    sets.push_back(&set);
    reach_.push_back(contact::enclosingRadius(set));
  }
  const contact::GrainPartModel model = grainPartModel(*setup.grains, grains, room_);
  force_ = model.force, torque_ = model.torque;
  contacts_ = std::make_unique<contact::GrainPartContacts>(exec, model, sets, parts, comm_, setup.grains->partLaws);
  if (auto* ranks = grains.distribution())
    ranks->onMigrate([this](const std::uint32_t* destination) { contacts_->migrate(destination); });
  motion_ = base::Mirrored<contact::PartMotion>(exec, sets_.size());
  sums_ = base::Mirrored<contact::PartLoad>(exec, sets_.size() + 1); // plus the number of crushed grains
  loads_.resize(sets_.size());
}

/// Depends only on the motions, so the result is equal on all ranks.
bool MeshContacts::haveLeft(const std::vector<contact::PartMotion>& motions) const {
  if (listedAt_.empty()) return true;
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const contact::PartMotion &was = listedAt_[k], &is = motions[k];
    double turned = 0; // sum of the chords of three axes; an upper bound of the rotation
    for (int column = 0; column < 3; ++column) {
      Vec3d chord;
      for (int row = 0; row < 3; ++row) chord[row] = is.rotation.m[row][column] - was.rotation.m[row][column];
      turned += norm(chord);
    }
    if (!(norm(is.origin - was.origin) + turned * reach_[k] <= room_)) return true;
  }
  return false;
}

void MeshContacts::place(const terrain::Grains& grains, const std::vector<contact::PartMotion>& motions,
                         bool slotsChanged) {
  std::copy(motions.begin(), motions.end(), motion_.host());
  motion_.upload();
  if (!slotsChanged && !haveLeft(motions)) return;
  contacts_->refresh(grains.view(), motion_.device());
  listedAt_ = motions;
}

contact::PartMomentsView MeshContacts::measure(const terrain::Grains& grains,
                                               const std::vector<contact::PartMotion>& motions, bool slotsChanged) {
  place(grains, motions, slotsChanged);
  return contacts_->measure(grains.view(), motion_.device());
}

void MeshContacts::computeContacts(const terrain::Grains& grains, const std::vector<contact::PartMotion>& motions,
                                   bool slotsChanged) {
  place(grains, motions, slotsChanged);
  sums_.device().zero();
  contacts_->compute(grains.view(), motion_.device(), sums_.device().data());
  grainLoads_ = contacts_->grainLoads();
  collect();
}

terrain::ImpulseParts MeshContacts::parts(const terrain::Grains& grains,
                                          const std::vector<contact::PartMotion>& motions, bool slotsChanged,
                                          contact::BodyResponse& response) {
  place(grains, motions, slotsChanged);
  sums_.device().zero();
  return {contacts_.get(), &motion_.device(), sums_.device().data(), &response};
}

void MeshContacts::collect() {
  sums_.download();
  base::synchronize(exec_);
  comm_.sum(&sums_.host()->force.x, 6 * sums_.size());
  for (std::size_t k = 0; k < loads_.size(); ++k)
    loads_[k] = {force_.value(sums_.host()[k].force), torque_.value(sums_.host()[k].torque)};
}

std::size_t MeshContacts::spheres() const {
  std::size_t total = 0;
  for (const base::SphereSet& set : sets_) total += set.spheres.size();
  return total;
}

void MeshContacts::restore(const contact::SavedGrainPatches& saved) {
  contacts_->restore(saved);
  listedAt_.clear();
}

} // namespace grouser::coupling
