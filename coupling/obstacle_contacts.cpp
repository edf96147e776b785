// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/obstacle_contacts.hpp"

#include "base/error.hpp"
#include "contact/part_surface.hpp"
#include "coupling/mesh_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace grouser::coupling {

using base::Vec3d;
using terrain::RigidContacts;

std::unique_ptr<ObstacleContacts> ObstacleContacts::make(const ContactParts& parts,
                                                         const std::vector<Obstacle>& obstacles,
                                                         const terrain::HeightField* hullOn, const Model& model,
                                                         const base::Comm& comm, SphereSets* kept) {
  if (obstacles.empty() && !hullOn && parts.pairs.empty()) return nullptr;
  std::unique_ptr<ObstacleContacts> made(new ObstacleContacts);
  std::vector<PartCut> cuts;
  for (const Obstacle& o : obstacles)
    if (o.surface.mesh) cuts.push_back(meshCut(o.surface, parts.contactSize));
  made->sets_ = cutParts(cuts, kept, comm, &made->cutReports_);
  std::vector<const base::SphereSet*> meshes;
  for (const base::SphereSet& set : made->sets_) meshes.push_back(&set);
  const int count = static_cast<int>(parts.count());
  int nextMesh = 0;

  std::vector<RigidContacts::Surface> surfaces;
  std::vector<RigidContacts::Pair> pairs;
  std::vector<int> touching;
  using Kind = RigidContacts::Surface::Kind;
  const auto meet = [&](int part, const contact::PatchLaw& law) {
    pairs.push_back({part, static_cast<int>(surfaces.size()) - 1, law});
    touching.push_back(part);
  };
  for (const Obstacle& o : obstacles) {
    surfaces.push_back({o.surface.mesh ? Kind::mesh : Kind::shape, o.surface.geometry, o.surface.mesh ? nextMesh++ : -1,
                        count + static_cast<int>(surfaces.size())});
    made->motions_.push_back(startingPose(o.surface).motion), made->names_.push_back(o.surface.name);
    for (int part = 0; part < count; ++part)
      if (const ContactPart& p = parts.parts[static_cast<std::size_t>(part)]; !p.fixed)
        meet(part, parts.onObstacle(p, o));
  }
  if (hullOn) {
    surfaces.push_back({Kind::field, {}, -1, count + static_cast<int>(surfaces.size())});
    made->motions_.push_back({{}, base::Mat3d::identity(), {}, {}, {}}), made->names_.emplace_back("the ground");
    for (int part = 0; part < count; ++part)
      if (const ContactPart& p = parts.parts[static_cast<std::size_t>(part)]; p.isHull) meet(part, p.foundation);
  }
  std::map<int, int> setOf; // [part surface] index in `meshes`
  for (const ContactParts::Pair& pair : parts.pairs) {
    const ContactPart& other = parts.parts[static_cast<std::size_t>(pair.other)];
    int set = -1;
    if (other.surface >= 0) {
      const auto [at, fresh] = setOf.emplace(other.surface, static_cast<int>(meshes.size()));
      if (fresh) meshes.push_back(parts.surfaces[static_cast<std::size_t>(other.surface)]);
      set = at->second;
    }
    surfaces.push_back({set < 0 ? Kind::shape : Kind::mesh, other.shape, set, pair.other});
    made->names_.push_back(other.name);
    meet(pair.part, pair.law);
  }
  made->contacts_ =
      std::make_unique<RigidContacts>(RigidContacts::Model{model.quanta, model.timeStep, parts.massOfParts()},
                                      parts.pointsOf(touching), parts.pointsOfPart(), surfaces, pairs, meshes, hullOn);
  return made;
}

void ObstacleContacts::requireShallow(const ContactParts& parts) const {
  if (const auto& deep = contacts_->tooDeep())
    failTooDeep(parts, *deep, names_[static_cast<std::size_t>(deep->surface)]);
}

void failTooDeep(const ContactParts& parts, const RigidContacts::TooDeep& deep, const std::string& surface) {
  const Vec3d& p = deep.place;
  throw base::SimulationError(
      fmt::format("{} overlaps {} by more than {:.3g} m at ({:.4g}, {:.4g}, {:.4g}) m (largest_overlap of [[body]]; "
                  "default: half of the smallest half extent), so it could pass through; raise "
                  "foundation_modulus of the materials, or lower loads, masses or speeds",
                  parts.parts[static_cast<std::size_t>(deep.part)].name, surface, deep.most, p.x, p.y, p.z),
      base::Cause::excessiveOverlap);
}

namespace {

constexpr double kMaxLift = 0.1; // [m]
constexpr double kClear = 1e-4;  // [m] gap between part and obstacle
constexpr int kMaxTries = 1000;  // more lifts indicate that the vehicle is beside a wall

/// Assembled part in the world.
struct Placed {
  base::Pose pose; ///< X_WP
  const base::SphereSet* set;
  double reach; ///< bounding radius about the pose's origin [m]
  std::string name;
};

std::vector<Placed> placedParts(const multibody::Model& model, const ContactParts& parts) {
  std::vector<double> reach;
  for (const base::SphereSet* set : parts.surfaces) reach.push_back(contact::enclosingRadius(*set));
  std::vector<Placed> placed;
  for (const ContactPart& part : parts.parts) {
    const auto set = static_cast<std::size_t>(part.surface);
    placed.push_back(
        {multibody::compose(model.bodies()[part.body].pose, part.pose_B), parts.surfaces[set], reach[set], part.name});
  }
  return placed;
}

/// Deepest overlap of a part's surface with an obstacle [m], with the part raised by `lift`; 0 without contact.
double depthIn(const Placed& part, const SurfaceSetup& surface, double lift) {
  const Vec3d up{0, 0, lift};
  const base::Pose& at = surface.start;
  if (overlapAt(surface, at, part.pose.position + up, part.reach) <= 0) return 0;
  double deepest = 0;
  for (std::size_t k = 0; k < part.set->surfaceCount; ++k) {
    const base::SetSphere& s = part.set->spheres[k];
    deepest = std::max(deepest, overlapAt(surface, at, part.pose.toWorld(s.centre) + up, s.radius));
  }
  return deepest;
}

} // namespace

double liftOffObstacles(const multibody::Model& model, const ContactParts& parts,
                        const std::vector<Obstacle>& obstacles) {
  if (obstacles.empty()) return 0;
  const std::vector<Placed> placed = placedParts(model, parts);
  double lift = 0;
  for (int tries = 0; tries < kMaxTries; ++tries) {
    double most = 0;
    const Placed* part = nullptr;
    const Obstacle* obstacle = nullptr;
    for (const Placed& p : placed)
      for (const Obstacle& o : obstacles)
        if (const double depth = depthIn(p, o.surface, lift); depth > most) most = depth, part = &p, obstacle = &o;
    if (!part) return lift;
    lift += most + kClear;
    if (lift > kMaxLift || tries + 1 == kMaxTries)
      throw base::InputError(fmt::format(
          "{}: overlaps the {} at the vehicle's start; raising the vehicle by {} mm does not clear it; move it or "
          "vehicle.position",
          obstacle->surface.place, part->name, 1e3 * kMaxLift));
  }
  return lift;
}

} // namespace grouser::coupling
