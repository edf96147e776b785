// SPDX-License-Identifier: BSD-3-Clause
#include "runs/simulation/vehicle_parts.hpp"

#include "contact/part_surface.hpp"
#include "spheredecomp/decompose.hpp"
#include "spheredecomp/mesh.hpp"

#include <filesystem>
#include <map>

namespace grouser::simulation {

namespace {

/// The set that rank `root` has, on all ranks.
base::SphereSet shared(const base::Comm& comm, base::SphereSet set, int root) {
  if (comm.alone()) return set;
  struct Scalars {
    std::size_t surfaceCount;
    double spacing, radius, meshVolume, meshArea;
  };
  const Scalars mine{set.surfaceCount, set.spacing, set.radius, set.meshVolume, set.meshArea};
  const auto all = base::Comm::valuesOf<Scalars>(comm.broadcast(base::Comm::bytesOf(std::vector{mine}), root)).front();
  set.spheres = base::Comm::valuesOf<base::SetSphere>(comm.broadcast(base::Comm::bytesOf(set.spheres), root));
  set.name = comm.broadcast(set.name, root);
  set.surfaceCount = all.surfaceCount, set.spacing = all.spacing, set.radius = all.radius;
  set.meshVolume = all.meshVolume, set.meshArea = all.meshArea;
  return set;
}

} // namespace

VehicleParts::VehicleParts(const vehicle::Assembly& assembly, double sphereRadius, const base::Comm& comm)
    : contactIndex_(assembly.parts.size(), -1) {
  std::map<std::string, std::size_t> indexOf;
  spheredecomp::DecompositionOptions options;
  options.radius = sphereRadius;
  for (std::size_t p = 0; p < assembly.parts.size(); ++p) {
    const vehicle::Part& part = assembly.parts[p];
    const bool touches = part.kind != vehicle::PartKind::kChassis;
    const auto [at, fresh] = indexOf.emplace(part.mesh, meshes_.size());
    if (fresh) {
      meshes_.push_back(
          spheredecomp::importMesh((std::filesystem::path(assembly.spec.meshFolder) / part.mesh).string()));
      const int cutter = static_cast<int>(sets_.size()) % comm.size();
      sets_.push_back(touches && cutter == comm.rank() ? spheredecomp::decompose(meshes_.back(), part.mesh, options)
                                                       : base::SphereSet{});
      setFigures_.push_back({part.mesh, 0, 0});
    }
    meshOfPart_.push_back(at->second);
    ++setFigures_[at->second].instances;
    if (!touches) continue;
    contactIndex_[p] = static_cast<int>(contactParts_.size());
    contactParts_.push_back(static_cast<int>(p));
  }
  share(comm);
  for (std::size_t c = 0; c < contactParts_.size(); ++c)
    reach_.push_back(contact::enclosingRadius(sets_[meshOfPart_[partOf(c)]]) +
                     norm(assembly.parts[partOf(c)].pose_B.position));
}

/// Every rank gets all sets.
void VehicleParts::share(const base::Comm& comm) {
  for (std::size_t i = 0; i < sets_.size(); ++i) {
    sets_[i] = shared(comm, std::move(sets_[i]), static_cast<int>(i) % comm.size());
    setFigures_[i].spheres = sets_[i].spheres.size();
  }
}

std::vector<const base::SphereSet*> VehicleParts::sets() const {
  std::vector<const base::SphereSet*> sets;
  for (const base::SphereSet& set : sets_) sets.push_back(&set);
  return sets;
}

std::vector<int> VehicleParts::setOfContactPart() const {
  std::vector<int> sets;
  for (std::size_t c = 0; c < contactParts_.size(); ++c) sets.push_back(static_cast<int>(meshOfPart_[partOf(c)]));
  return sets;
}

std::size_t VehicleParts::totalSpheres() const {
  std::size_t total = 0;
  for (const SetFigures& f : setFigures_) total += f.spheres * static_cast<std::size_t>(f.instances);
  return total;
}

} // namespace grouser::simulation
