// SPDX-License-Identifier: BSD-3-Clause
// Rigid surfaces that may move: where they are, and what the grains do to them.
#include "terrain/grains.hpp"

#include <algorithm>
#include <stdexcept>

namespace grouser::terrain {

void Grains::makeSurfaces(const Boundaries& boundaries) {
  std::vector<SurfacePose> start;
  // A contact as stiff as it gets takes 2^40 quanta: room for eight million of them on one surface.
  double pressed = 0;
  const auto consider = [&](const contact::ContactLaw& law) {
    pressed = std::max(pressed, law.stiffness * model_.radius * (law.hertz ? 0.1 * model_.radius : 1.0));
  };
  for (const RigidSurface& surface : boundaries.surfaces) {
    geometries_.push_back(surface.geometry), start.push_back(surface.start);
    consider(surface.law);
  }
  for (const contact::ContactLaw& law : model_.materials.boundaries) consider(law);
  surfaces_ = base::Array<SurfaceGeometry>(exec_, geometries_);
  fromSurfaces_ = base::Array<base::Vec3d>(exec_);
  if (start.empty()) return;
  placements_ = base::Mirrored<SurfacePose>(exec_, start.size());
  surfaceSums_ = base::Mirrored<contact::PartLoad>(exec_, start.size());
  surfaceLoads_.resize(start.size());
  surfaceForce_ = surfaceTorque_ = base::fixedPointFor(pressed, 40);
  setSurfacePoses(start);
}

void Grains::setSurfacePoses(const std::vector<SurfacePose>& placements) {
  if (placements.size() != geometries_.size()) throw std::logic_error("as many placements as surfaces");
  std::copy(placements.begin(), placements.end(), placements_.host());
  placements_.upload();
}

/// Decided from the placements alone, so alike on all ranks.
bool Grains::surfacesHaveLeft() const {
  for (std::size_t s = 0; s < geometries_.size(); ++s) {
    const SurfaceTravel room = roomOf(geometries_[s], surfaceWay());
    const SurfaceTravel gone = travelBetween(geometries_[s], listedAt_[s], placements_.host()[s]);
    if (!(gone.way <= room.way && gone.turn <= room.turn)) return true;
  }
  return false;
}

void Grains::collectSurfaceLoads() {
  contact::PartLoad* sums = surfaceSums_.host();
  static_assert(sizeof(contact::PartLoad) == 6 * sizeof(std::int64_t));
  if (subdomain_) subdomain_->comm().sum(&sums->force.x, 6 * surfaceSums_.size());
  for (std::size_t s = 0; s < surfaceLoads_.size(); ++s)
    surfaceLoads_[s] = {surfaceForce_.checked(sums[s].force, "forces on a surface"),
                        surfaceTorque_.checked(sums[s].torque, "torques on a surface")};
}

} // namespace grouser::terrain
