// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/vehicle_parts.hpp"

#include "contact/part_surface.hpp"
#include "coupling/obstacles.hpp"
#include "spheredecomp/mesh.hpp"
#include "vehicle/shoe_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace grouser::coupling {

using base::Vec3d;

VehicleParts::VehicleParts(const vehicle::Assembly& assembly, const VehicleSetup& setup, const base::Comm& comm,
                           SphereSets* kept, double smallestGrain, bool shapesAlone)
    : contactIndex_(assembly.parts.size(), -1), spec_(assembly.spec), shapes_(setup.shapes),
      pointSpacing_(std::min(setup.sphereRadius, 0.05 * spec_.shoe.pitch) / setup.sphereRefinement) {
  std::map<std::string, std::size_t> indexOf;
  std::vector<std::size_t> touching; // meshes to be cut
  std::vector<std::size_t> hulls;    // parts
  for (std::size_t p = 0; p < assembly.parts.size(); ++p) {
    const vehicle::Part& part = assembly.parts[p];
    const bool isHull = part.kind == vehicle::PartKind::kChassis, touches = isHull ? setup.hullTouches : !shapesAlone;
    const auto [at, fresh] = indexOf.emplace(part.mesh, meshes_.size());
    if (fresh) {
      meshes_.push_back(
          spheredecomp::importMesh((std::filesystem::path(assembly.spec.meshFolder) / part.mesh).string()));
      if (touches) touching.push_back(at->second);
      setFigures_.push_back({part.mesh, 0, 0});
    }
    meshOfPart_.push_back(at->second);
    ++setFigures_[at->second].instances;
    if (isHull)
      hulls.push_back(p);
    else
      addContactPart(p);
  }
  // The hull is last, so that the indices of the other parts do not depend on it.
  if (setup.hullTouches)
    for (const std::size_t hull : hulls) addContactPart(hull);
  cut(touching, hulls.empty() ? meshes_.size() : meshOfPart_[hulls.front()], setup,
      std::min(contactSize(assembly.spec), smallestGrain), kept, comm);
  for (std::size_t c = 0; c < contactParts_.size(); ++c) {
    const std::size_t mesh = meshOfPart_[partOf(c)];
    double reach = contact::enclosingRadius(sets_[mesh]);
    if (sets_[mesh].spheres.empty())
      for (const Vec3d& v : meshes_[mesh].vertices) reach = std::max(reach, norm(v));
    reach_.push_back(reach + norm(assembly.parts[partOf(c)].pose_B.position));
  }
}

void VehicleParts::addContactPart(std::size_t part) {
  contactIndex_[part] = static_cast<int>(contactParts_.size());
  contactParts_.push_back(static_cast<int>(part));
}

void VehicleParts::cut(const std::vector<std::size_t>& meshes, std::size_t hull, const VehicleSetup& setup,
                       double contactSize, SphereSets* kept, const base::Comm& comm) {
  constexpr double kPermitted = 0.05; // protrusion [contact size]
  // Limits for the hull, which is rarely in contact: [sphere radius], and [diagonal] of a small hull. The limit of the
  // other parts, 1.9 mm for shoes of 154 mm, would need too many spheres for a hull of 40 m2. By default the hulls of
  // the supplied vehicles protrude by 6.0, 6.0 and 0.7 mm at a sphere radius of 20 mm, and keep their cut.
  constexpr double kHullPermitted = 0.35, kSmallHullPermitted = 0.005;
  std::vector<PartCut> parts;
  for (const std::size_t m : meshes) {
    parts.push_back({&meshes_[m], setFigures_[m].mesh, {}});
    const bool isHull = m == hull, given = isHull ? setup.hullSphereRadiusGiven : setup.sphereRadiusGiven;
    const auto [low, high] = spheredecomp::bounds(meshes_[m]);
    const Vec3d size = high - low;
    double& radius = parts.back().options.radius;
    radius = isHull ? setup.hullSphereRadius : setup.sphereRadius;
    if (!given) radius = std::min(radius, 0.5 * std::max({size.x, size.y, size.z}));
    radius /= setup.sphereRefinement;
    parts.back().options.interior = !isHull;
    parts.back().key = isHull ? "vehicle.hull_sphere_radius" : "vehicle.sphere_radius";
    parts.back().place = fmt::format("{} ({})", setFigures_[m].mesh, parts.back().key);
    const double ofHull = std::min(kHullPermitted * setup.hullSphereRadius, kSmallHullPermitted * norm(size));
    const double permitted = (isHull ? ofHull : kPermitted * contactSize) / setup.sphereRefinement;
    parts.back().limit = {.permitted = permitted,
                          .contactSize = isHull ? 10 * permitted : contactSize / setup.sphereRefinement,
                          .automatic = !given};
  }
  std::vector<base::SphereSet> sets = cutParts(parts, kept, comm, &cutReports_);
  sets_.resize(meshes_.size());
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    sets_[meshes[i]] = std::move(sets[i]);
    setFigures_[meshes[i]].spheres = sets_[meshes[i]].spheres.size();
  }
}

ContactParts VehicleParts::touching(const vehicle::Assembly& assembly, bool shoesAlone) const {
  ContactParts all;
  for (const base::SphereSet& set : sets_) all.surfaces.push_back(&set);
  const vehicle::ContactSpec& spec = assembly.spec.contact;
  const auto foundation = [&spec](double modulus) {
    return contact::PatchLaw{modulus, spec.relaxationTime, spec.frictionGround, spec.tangentialRatio};
  };
  for (std::size_t c = 0; c < contactParts_.size(); ++c) {
    const vehicle::Part& part = assembly.parts[partOf(c)];
    const bool isShoe = part.kind == vehicle::PartKind::kShoe;
    all.parts.push_back({.name = part.name,
                         .body = static_cast<std::size_t>(part.body),
                         .pose_B = part.pose_B,
                         .surface = static_cast<int>(meshOfPart_[partOf(c)]),
                         .points = static_cast<int>(meshOfPart_[partOf(c)]),
                         .foundation = foundation(isShoe ? spec.onGround() : spec.foundationModulus),
                         .reach = reach_[c],
                         .canTouchGrains = isShoe || !shoesAlone,
                         .isHull = part.kind == vehicle::PartKind::kChassis,
                         .shown = partOf(c)});
  }
  for (const int part : assembly.groundParts)
    all.parts[static_cast<std::size_t>(contactIndex(part))].canTouchGround = true;
  all.pointSets = sets_.size();
  all.points = [this](int set) { return points(static_cast<std::size_t>(set)); };
  all.onObstacle = [](const ContactPart& part, const Obstacle& o) {
    contact::PatchLaw law = part.foundation;
    law.friction = o.friction;
    return law;
  };
  all.contactSize = contactSize(assembly.spec);
  all.weight = assembly.mass * kLoadScale;
  return all;
}

contact::PointTree VehicleParts::points(std::size_t set) const {
  const bool byShapes = shapes_ && setFigures_[set].mesh == spec_.shoe.mesh;
  return contact::PointTree(byShapes ? vehicle::shoePoints(spec_, pointSpacing_)
                                     : contact::surfaceSamplesOf(sets_[set]));
}

std::size_t VehicleParts::totalSpheres() const {
  std::size_t total = 0;
  for (const SetFigures& f : setFigures_) total += f.spheres * static_cast<std::size_t>(f.instances);
  return total;
}

} // namespace grouser::coupling
