// SPDX-License-Identifier: BSD-3-Clause
#include "scm/body_contacts.hpp"

#include "scm/shear.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::scm {

namespace {

/// Coverage of a node's square by the underside of a body.
struct Cover {
  double share{}; ///< [-]
  Underside mean; ///< mean of the covered points at the node, each extrapolated by its tangent plane
};

/// Ignores parts of the body above `ceiling` [m].
Cover coverAt(const Undersides& undersides, double x, double y, double h, double ceiling) {
  constexpr int kSide = 4; // points along a side of the square
  const auto corner = [&](double u, double v) {
    return undersides.lowestAt(x + 0.499 * h * u, y + 0.499 * h * v, ceiling).has_value();
  };
  double clearance = 0;
  const std::optional<Underside> middle = undersides.lowestAt(x, y, ceiling, &clearance);
  if (!middle && clearance > h) return {}; // farther than the corners
  if (middle && corner(-1, -1) && corner(1, -1) && corner(-1, 1) && corner(1, 1)) return {1, *middle};
  Cover c;
  int hits = 0;
  for (int b = 0; b < kSide; ++b)
    for (int a = 0; a < kSide; ++a) {
      const double u = h * ((a + 0.5) / kSide - 0.5), v = h * ((b + 0.5) / kSide - 0.5);
      const std::optional<Underside> hit = undersides.lowestAt(x + u, y + v, ceiling);
      if (!hit || -hit->normal.z < kSteepest) continue;
      const Vec3d& n = hit->normal;
      ++hits, c.mean.z += hit->z + (n.x * u + n.y * v) / n.z, c.mean.normal += n;
    }
  if (hits == 0) return {};
  c.share = static_cast<double>(hits) / (kSide * kSide);
  c.mean.z /= hits, c.mean.normal = c.mean.normal * (1 / norm(c.mean.normal));
  return c;
}

} // namespace

BodyContacts::BodyContacts(SoilMap& map, LoadedNodes& loaded, std::vector<Solid> solids)
    : map_(map), loaded_(loaded), solids_(std::move(solids)), last_(solids_.size()), now_(solids_.size()),
      loads_(solids_.size()) {}

void BodyContacts::gather(const contact::PartMotion* motion) {
  for (std::size_t k = 0; k < solids_.size(); ++k) gather(k, motion[solids_[k].part]);
}

void BodyContacts::press(const contact::PartMotion* motion, double timeStep, SoilEnergy& energy) {
  for (std::size_t k = 0; k < solids_.size(); ++k) press(k, motion[solids_[k].part], timeStep, energy);
}

void BodyContacts::gather(std::size_t body, const contact::PartMotion& motion) {
  const Solid& solid = solids_[body];
  std::vector<Contact>& contacts = now_[body];
  contacts.clear();
  const double h = map_.spacing(), k = loaded_.soil().modulusAt(breadthOf(solid, motion));
  const Undersides undersides(solid, motion);
  const Vec3d half = undersides.half(), centre = motion.origin;
  const double bottom = centre.z - half.z;
  const auto firstI = static_cast<std::int32_t>(std::ceil((centre.x - half.x) / h - 0.5));
  const auto lastI = static_cast<std::int32_t>(std::floor((centre.x + half.x) / h + 0.5));
  const auto firstJ = static_cast<std::int32_t>(std::ceil((centre.y - half.y) / h - 0.5));
  const auto lastJ = static_cast<std::int32_t>(std::floor((centre.y + half.y) / h + 0.5));
  for (std::int32_t j = firstJ; j <= lastJ; ++j)
    for (std::int32_t i = firstI; i <= lastI; ++i) {
      Node& node = map_.at(i, j);
      const double top = node.height + node.looseThickness() + kNear;
      if (top < bottom) continue;
      const Cover cover =
          coverAt(undersides, h * i, h * j, h, top + 2.5 * h); // no contact surface rises more than that within h
      if (!(cover.share > 0) || -cover.mean.normal.z < kSteepest) continue;
      const double gap = node.height - cover.mean.z;
      if (cover.mean.z > top) continue;
      const double depth = gap * node.cosine;
      Contact& c = contacts.emplace_back();
      c.i = i, c.j = j, c.node = &node, c.loaded = loaded_.add(node, depth, k), c.depth = depth;
      c.up = -cover.mean.normal, c.z = cover.mean.z, c.area = cover.share * h * h / node.cosine;
      c.face = cover.share * h * h / c.up.z;
    }
}

void BodyContacts::press(std::size_t body, const contact::PartMotion& motion, double timeStep, SoilEnergy& energy) {
  Last& last = last_[body];
  BodyLoad& load = loads_[body];
  load = {};
  const SoilConstants& soil = loaded_.soil();
  const double K = soil.shearDisplacement, h = map_.spacing();
  FormerContacts<Contact> former(last.contacts);
  const auto ended = [&](const Contact& c) {
    release(c, energy), releaseShear(energy, K, c.strength * c.face, norm2(c.shear));
  };
  for (Contact& c : now_[body]) {
    const Contact* before = former.match(c, ended);
    c.pressure = scm::press(c, before, loaded_, energy);
    c.strength = c.pressure > 0 ? soil.cohesion + c.pressure * soil.friction : 0;
    const Vec3d place{h * c.i, h * c.j, c.z};
    if (c.pressure > 0) {
      const double sinking = std::max(0.0, -dot(motion.velocityAt(place), c.up));
      const Vec3d force = c.up * (c.face * (c.pressure + soil.damping * sinking));
      energy.damping += c.face * soil.damping * sinking * sinking * timeStep;
      load.force += force, load.torque += cross(place - motion.centre, force);
      load.area += c.face, load.sinkage = std::max(load.sinkage, c.depth);
    }
    if (!before) continue;
    const double strengthBefore = before->strength * before->face, strength = c.strength * c.face;
    if (!(strengthBefore > 0 && strength > 0)) {
      releaseShear(energy, K, strengthBefore, norm2(before->shear));
      continue;
    }
    // Rotate the stress into the current tangent plane, then add the shear displacement of the step.
    const Vec3d flat = before->shear - c.up * dot(before->shear, c.up);
    const double size = norm(flat);
    const Vec3d turned = size > 0 ? flat * (norm(before->shear) / size) : Vec3d{};
    const Vec3d moved = place - last.motion.toWorld(motion.toPart(place));
    const Vec3d slip = moved - c.up * dot(moved, c.up);
    const double slipped = norm(slip);
    c.shear = turned;
    double loss = 0;
    if (slipped > 0) {
      // Components along the slip and across it, in the tangent plane.
      const Vec3d along = slip * (1 / slipped), across = cross(c.up, along);
      Shear s{dot(turned, along), dot(turned, across)};
      loss = advance(s, slipped, 0, K).loss;
      c.shear = along * s.x + across * s.y;
      loaded_.slip(c.loaded, slipped);
    }
    addShear(energy, K, strengthBefore, strength, norm2(c.shear), loss);
    const Vec3d change = c.shear - turned;
    const Vec3d damped = change * shearDamping(soil, timeStep, c.face, strength, norm(change));
    energy.damping += dot(damped, slip);
    const Vec3d force = c.shear * -strength - damped;
    load.force += force, load.torque += cross(place - motion.centre, force);
  }
  former.finish(ended);
  last.motion = motion;
  std::swap(last.contacts, now_[body]);
}

void BodyContacts::save(NumberStream& numbers) const {
  std::vector<Last> all = last_;
  stream(numbers, all);
}
void BodyContacts::restore(NumberStream& numbers) { stream(numbers, last_); }

void BodyContacts::stream(NumberStream& numbers, std::vector<Last>& all) const {
  for (Last& last : all) {
    contact::PartMotion& m = last.motion;
    numbers(m.origin, m.centre, m.velocity, m.spin);
    for (auto& row : m.rotation.m)
      for (double& value : row) numbers(value);
    streamContacts(numbers, last.contacts, map_,
                   [&](Contact& c) { numbers(c.z, c.up, c.pressure, c.strength, c.shear); });
  }
}

} // namespace grouser::scm
