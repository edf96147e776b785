// SPDX-License-Identifier: BSD-3-Clause
#include "scm/body_contacts.hpp"

#include "scm/breadth.hpp"
#include "scm/shear.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::scm {

namespace {

constexpr double kSteep = 0.5, kFlank = 0.2; // cosines between which a facet becomes a flank

/// Share of a piece that is not a flank [-].
double flatShare(double cosine) { return std::clamp((cosine - kFlank) / (kSteep - kFlank), 0.0, 1.0); }

/// Height above the soil [m] from which a facet cannot reach the surface within the square by its slope.
double reachOf(double cosine, double h) {
  return 1.5 * h * ::sqrt(std::max(0.0, 1 - cosine * cosine)) / cosine + kNear;
}

/// Area of a piece, and sum of its depth over the area. Above the soil, whose depth is `surface`, the weight falls
/// linearly from 1 to 0 at the height `reach`.
struct Weighted {
  double area{};
  Vec3d sum;
};
Weighted weightedOf(const Polygon& outline, double surface, double reach, Polygon& above) {
  Weighted w;
  double highest = base::kInfinity;
  for (const Vec3d& p : outline) highest = std::min(highest, p.z);
  const auto add = [&](const Polygon& part, bool falls) {
    forEachTriangle(part, [&](double a, const Vec3d& q0, const Vec3d& q1, const Vec3d& q2) {
      for (const Vec3d& q : {(q0 + q1) * 0.5, (q1 + q2) * 0.5, (q2 + q0) * 0.5}) { // exact for quadratic functions
        const double weight = a / 3 * (falls ? 1 + (q.z - surface) / reach : 1);
        w.area += weight, w.sum += q * weight;
      }
    });
  };
  if (highest >= surface) {
    add(outline, false);
    return w;
  }
  clip(
      outline, [&](const Vec3d& p) { return p.z - surface; }, above);
  add(above, false);
  Polygon dry;
  clip(
      outline, [&](const Vec3d& p) { return surface - p.z; }, dry);
  clip(
      dry, [&](const Vec3d& p) { return p.z - surface + reach; }, above);
  add(above, true);
  return w;
}

} // namespace

struct BodyContacts::Step {
  const contact::PartMotion &motion, &before;
  BodyLoad& load;
  double timeStep;
  SoilEnergy& energy;
};

BodyContacts::BodyContacts(SoilMap& map, LoadedNodes& loaded, std::vector<Solid> solids)
    : map_(map), loaded_(loaded), solids_(std::move(solids)), loads_(solids_.size()) {
  for (std::size_t s = 0; s < solids_.size(); ++s)
    if (s > 0 && solids_[s].body == solids_[s - 1].body)
      ++bodies_.back().count;
    else
      bodies_.push_back({s, 1});
  last_.resize(bodies_.size()), now_.resize(bodies_.size()), flanksNow_.resize(bodies_.size());
}

void BodyContacts::gather(const contact::PartMotion* motion) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) gather(b, motion);
}

void BodyContacts::press(const contact::PartMotion* motion, double timeStep, SoilEnergy& energy) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) press(b, motion[solids_[bodies_[b].first].part], timeStep, energy);
}

void BodyContacts::gather(std::size_t body, const contact::PartMotion* motion) {
  now_[body].clear(), flanksNow_[body].clear();
  const Solid* solids = &solids_[bodies_[body].first];
  underside_.cut(map_, solids, bodies_[body].count, motion);
  if (underside_.cells().empty()) return;
  const std::vector<double> breadths = breadthsOf(solids, bodies_[body].count, motion);
  for (const Cell& cell : underside_.cells()) {
    double deepest = -base::kInfinity, breadth = breadths.front();
    for (const Piece& p : cell.pieces)
      if (const double depth = p.depthAt(meanOf(p.outline).mean); depth > deepest)
        deepest = depth, breadth = breadths[p.solid];
    gather(body, cell, loaded_.soil().modulusAt(breadth));
  }
}

void BodyContacts::gather(std::size_t body, const Cell& cell, double k) {
  const double h = map_.spacing(), cosine = cell.node->cosine;
  const SoilConstants& soil = loaded_.soil();
  const Node& node = *cell.node;
  const double surface = node.looseQuanta > 0 ? node.firmDepth() - node.looseThickness() * cosine : node.slipSinkage;
  double share = 0, flat = 0, flankArea = 0, flankWeight = 0, cohesive = 0;
  Vec3d mean, pushed, normals, flank, flankMean; // sums
  for (const Piece& p : cell.pieces) {
    const double level = flatShare(p.cosine),
                 limit = std::min(1.0, soil.elasticRatio * std::max(1.0, soil.exponent) * p.cosine);
    const Vec3d perArea = p.up * (1 / (p.cosine * cosine)); // area vector of the face per horizontal area
    if (level > 0) {
      const Weighted w = weightedOf(p.outline, -node.looseThickness(), reachOf(p.cosine, h), wet_);
      const double a = level * w.area;
      share += a, mean += w.sum * level, pushed += perArea * (a * limit), cohesive += a * limit / p.cosine;
      flat += a / p.cosine, normals += p.up * a;
    }
    if (!(level < 1)) continue;
    clip(
        p.outline, [&](const Vec3d& q) { return q.z - surface; }, wet_);
    forEachTriangle(wet_, [&](double a, const Vec3d& q0, const Vec3d& q1, const Vec3d& q2) {
      const double part = (1 - level) * limit * a / 3;
      for (const Vec3d& q : {(q0 + q1) * 0.5, (q1 + q2) * 0.5, (q2 + q0) * 0.5}) { // exact for quadratic functions
        const double weight = part * k * loaded_.curve().at(std::max(0.0, q.z - surface));
        flank += perArea * weight, flankMean += q * weight, flankWeight += weight;
      }
      flankArea += 3 * part / (p.cosine * cosine);
    });
  }
  if (share > 0 && norm(normals) > 0) {
    mean *= 1 / share;
    Contact& c = now_[body].emplace_back();
    c.i = cell.i, c.j = cell.j, c.node = cell.node, c.depth = mean.z;
    c.loaded = loaded_.add(*cell.node, mean.z, k, std::min(1.0, share / (h * h)));
    c.area = share / cosine, c.face = norm(pushed), c.place = cell.toWorld(h, mean);
    c.up = pushed * (1 / c.face), c.cohesive = cohesive / flat;
  }
  if (flankWeight > 0) {
    Contact& c = flanksNow_[body].emplace_back();
    flankMean *= 1 / flankWeight;
    c.i = cell.i, c.j = cell.j, c.node = cell.node, c.place = cell.toWorld(h, flankMean);
    c.depth = flankMean.z - surface;
    const double force = norm(flank);
    c.face = flankArea, c.up = flank * (1 / force), c.pressure = force / flankArea, c.cohesive = 1;
  }
}

void BodyContacts::press(std::size_t body, const contact::PartMotion& motion, double timeStep, SoilEnergy& energy) {
  Last& last = last_[body];
  BodyLoad& load = loads_[bodies_[body].first];
  load = {};
  const double K = loaded_.soil().shearDisplacement;
  const Step step{motion, last.motion, load, timeStep, energy};
  const auto ended = [&](const Contact& c) { releaseShear(energy, K, c.strength * c.face, norm2(c.shear)); };
  double pressed = 0, virgin = 0; // load on the facets that are not flanks [N]
  FormerContacts<Contact> former(last.contacts);
  const auto endedNode = [&](const Contact& c) { release(c, energy), ended(c); };
  for (Contact& c : now_[body]) {
    const Contact* before = former.match(c, endedNode);
    c.pressure = scm::press(c, before, loaded_, energy);
    const LoadedNode& node = loaded_[c.loaded];
    if (const double sinkage = c.depth - node.offset; sinkage > 0)
      virgin += c.area * node.modulus * loaded_.curve().at(sinkage), pressed += c.area * c.pressure;
    if (c.pressure > 0) load.sinkage = std::max(load.sinkage, c.depth);
    const double slipped = add(c, before, step);
    if (slipped > 0) loaded_.slip(c.loaded, slipped);
  }
  former.finish(endedNode);
  const double mobilised = virgin > 0 ? std::min(1.0, pressed / virgin) : now_[body].empty() ? 1 : 0;
  FormerContacts<Contact> formerFlanks(last.flanks);
  for (Contact& c : flanksNow_[body]) {
    const Contact* before = formerFlanks.match(c, ended);
    c.pressure *= mobilised;
    pressFlank(c, before, step);
    add(c, before, step);
  }
  formerFlanks.finish(ended);
  last.motion = motion;
  std::swap(last.contacts, now_[body]), std::swap(last.flanks, flanksNow_[body]);
}

void BodyContacts::pressFlank(Contact& c, const Contact* before, const Step& step) const {
  const SoilConstants& soil = loaded_.soil();
  const double unloading = c.depth / (soil.elasticRatio * std::max(1.0, soil.exponent)); // p / k_u at the mean depth
  const Vec3d moved = c.place - step.before.toWorld(step.motion.toPart(c.place));
  if (before)
    c.retreat = std::clamp(before->retreat + dot(moved, c.up), 0.0, unloading);
  else if (dot(step.motion.velocityAt(c.place), c.up) > 0)
    c.retreat = unloading;
  c.pressure *= 1 - c.retreat / unloading;
  if (before) step.energy.compaction -= c.face * c.pressure * dot(c.up, moved);
}

double BodyContacts::add(Contact& c, const Contact* before, const Step& step) const {
  const SoilConstants& soil = loaded_.soil();
  const double K = soil.shearDisplacement;
  const contact::PartMotion& motion = step.motion;
  SoilEnergy& energy = step.energy;
  const auto push = [&](const Vec3d& force) {
    step.load.force += force, step.load.torque += cross(c.place - motion.centre, force);
  };
  c.strength = c.pressure > 0 ? soil.cohesion * c.cohesive + c.pressure * soil.friction : 0;
  if (c.pressure > 0) {
    const double sinking = std::max(0.0, -dot(motion.velocityAt(c.place), c.up));
    energy.damping += c.face * soil.damping * sinking * sinking * step.timeStep;
    push(c.up * (c.face * (c.pressure + soil.damping * sinking)));
    step.load.area += c.face;
  }
  if (!before) return 0;
  const double strengthBefore = before->strength * before->face, strength = c.strength * c.face;
  if (!(strengthBefore > 0 && strength > 0)) {
    releaseShear(energy, K, strengthBefore, norm2(before->shear));
    return 0;
  }
  // Rotate the stress into the current tangent plane, then add the shear displacement of the step.
  const Vec3d flat = before->shear - c.up * dot(before->shear, c.up);
  const double size = norm(flat);
  const Vec3d turned = size > 0 ? flat * (norm(before->shear) / size) : Vec3d{};
  const Vec3d moved = c.place - step.before.toWorld(motion.toPart(c.place));
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
  }
  addShear(energy, K, strengthBefore, strength, norm2(c.shear), loss);
  const Vec3d change = c.shear - turned;
  const Vec3d damped = change * shearDamping(soil, step.timeStep, c.face, strength, norm(change));
  energy.damping += dot(damped, slip);
  push(c.shear * -strength - damped);
  return slipped;
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
    for (std::vector<Contact>* list : {&last.contacts, &last.flanks})
      streamContacts(numbers, *list, map_, [&](Contact& c) {
        numbers(c.place, c.up, c.pressure, c.retreat, c.cohesive, c.strength, c.shear);
      });
  }
}

} // namespace grouser::scm
