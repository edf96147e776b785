// SPDX-License-Identifier: BSD-3-Clause
#include "scm/pad_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::scm {

namespace {

/// Share of a node's square within a pad along one axis; `perWidth`: 1 / width of the square along that axis [1/m].
double shareOf(double place, double half, double perWidth) {
  return std::clamp((half - std::fabs(place)) * perWidth + 0.5, 0.0, 1.0);
}
/// Number of the piece along one axis; `perHalf`: pieces per half side [1/m].
int pieceOf(double place, double half, double perHalf, int count) {
  return std::clamp(static_cast<int>((place + half) * perHalf), 0, count - 1);
}

/// Stress s of the last step in the present plane of the pad, of the same size.
Shear turned(const Shear& s, const Vec3d& lastU, const Vec3d& lastV, const Vec3d& u, const Vec3d& v) {
  const Vec3d stress = lastU * s.x + lastV * s.y;
  const double x = dot(stress, u), y = dot(stress, v), now = ::sqrt(x * x + y * y);
  if (!(now > 0)) return {};
  const double size = ::sqrt(s.square()) / now;
  return {x * size, y * size};
}

} // namespace

PadContacts::PadContacts(SoilMap& map, LoadedNodes& loaded, std::vector<Pad> pads)
    : map_(map), loaded_(loaded), sides_(loaded.soil()), pads_(std::move(pads)), moduli_(pads_.size()),
      last_(pads_.size()), now_(pads_.size()), loads_(pads_.size()) {
  const SoilConstants& soil = loaded.soil();
  for (const Pad& p : pads_) {
    const ShearStrength rough{soil.cohesion, soil.friction};
    strengths_.push_back(p.grousers ? shoeStrength(soil, *p.grousers, 2 * p.halfLength, 2 * p.halfWidth)
                                    : ShoeStrength{rough, rough});
  }
}

/// b of each pad: of a track the smaller of its width and the length of the run of pads in contact that it belongs to or
/// will lengthen.
void PadContacts::updateBreadths() {
  for (std::size_t first = 0, end = 0; first < pads_.size(); first = end) {
    for (end = first + 1; end < pads_.size() && pads_[first].track >= 0 && pads_[end].track == pads_[first].track;) ++end;
    const std::size_t count = end - first;
    const auto touches = [&](std::size_t k) { return last_[first + k % count].touches; };
    for (std::size_t k = 0; k < count; ++k) {
      const Pad& p = pads_[first + k];
      std::size_t run = 1;
      // No run needs to be longer than the breadth.
      const double enough = p.track >= 0 && p.pitch > 0 ? std::ceil((p.breadth - 2 * p.halfLength) / p.pitch) + 1 : 1;
      const auto most = std::min(count, static_cast<std::size_t>(std::max(1.0, enough)));
      for (std::size_t n = 1; run < most && touches(k + n); ++n) ++run;
      for (std::size_t n = 1; run < most && touches(k + count - n); ++n) ++run;
      const double length = 2 * p.halfLength + static_cast<double>(run - 1) * p.pitch;
      moduli_[first + k] = loaded_.soil().modulusAt(p.track >= 0 ? std::min(p.breadth, length) : p.breadth);
    }
  }
}

void PadContacts::gather(const contact::PartMotion* motion) {
  updateBreadths();
  for (std::size_t k = 0; k < pads_.size(); ++k) gather(k, motion[pads_[k].part]);
}

void PadContacts::press(const contact::PartMotion* motion, double timeStep, SoilEnergy& energy) {
  for (std::size_t k = 0; k < pads_.size(); ++k) press(k, motion[pads_[k].part], timeStep, energy);
}

void PadContacts::gather(std::size_t pad, const contact::PartMotion& motion) {
  const Pad& p = pads_[pad];
  std::vector<Contact>& contacts = now_[pad];
  contacts.clear();
  const Vec3d u = motion.rotation * p.along, v = motion.rotation * p.across;
  const Vec3d up = cross(u, v);
  if (up.z < kSteepest) return;
  const Vec3d centre = motion.toWorld(p.centre);
  // Widths of a node's square across the pad's sides.
  const double h = map_.spacing();
  const double widthU = h * (std::fabs(u.x) + std::fabs(u.y)), widthV = h * (std::fabs(v.x) + std::fabs(v.y));
  const double halfU = p.halfLength + 0.5 * widthU, halfV = p.halfWidth + 0.5 * widthV;
  const double reachX = std::fabs(u.x) * halfU + std::fabs(v.x) * halfV;
  const double reachY = std::fabs(u.y) * halfU + std::fabs(v.y) * halfV;
  const double k = moduli_[pad], area = h * h / up.z, slopeX = -up.x / up.z, slopeY = -up.y / up.z;
  const auto firstI = static_cast<std::int32_t>(std::ceil((centre.x - reachX) / h));
  const auto lastI = static_cast<std::int32_t>(std::floor((centre.x + reachX) / h));
  const auto firstJ = static_cast<std::int32_t>(std::ceil((centre.y - reachY) / h));
  const auto lastJ = static_cast<std::int32_t>(std::floor((centre.y + reachY) / h));
  const double perWidthU = 1 / widthU, perWidthV = 1 / widthV;
  const double perHalfU = 0.5 * kAlong / p.halfLength, perHalfV = 0.5 * kAcross / p.halfWidth;
  const double bottom = centre.z - std::fabs(u.z) * halfU - std::fabs(v.z) * halfV;
  if (bottom > map_.topOf(firstI, lastI, firstJ, lastJ) + kNear) return;
  for (std::int32_t j = firstJ; j <= lastJ; ++j)
    for (std::int32_t i = firstI; i <= lastI; ++i) {
      const double x = h * i - centre.x, y = h * j - centre.y, plate = slopeX * x + slopeY * y;
      const double placeU = x * u.x + y * u.y + plate * u.z, placeV = x * v.x + y * v.y + plate * v.z;
      const double share = shareOf(placeU, p.halfLength, perWidthU) * shareOf(placeV, p.halfWidth, perWidthV);
      if (!(share > 0)) continue;
      Node& node = map_.at(i, j);
      const double gap = node.height - (centre.z + plate);
      if (gap < -kNear - node.looseThickness()) continue;
      const double depth = gap * node.cosine;
      const int a = pieceOf(placeU, p.halfLength, perHalfU, kAlong);
      const int b = pieceOf(placeV, p.halfWidth, perHalfV, kAcross);
      Contact& c = contacts.emplace_back();
      c.i = i, c.j = j, c.node = &node, c.loaded = loaded_.add(node, depth, k), c.depth = depth;
      c.area = share * h * h / node.cosine, c.face = share * area;
      c.piece = a * kAcross + b, c.u = placeU, c.v = placeV;
    }
}

void PadContacts::press(std::size_t pad, const contact::PartMotion& motion, double timeStep, SoilEnergy& energy) {
  Last& last = last_[pad];
  PadLoad& load = loads_[pad];
  load = {};
  if (now_[pad].empty() && last.contacts.empty() && !last.touches) {
    last.isThere = false;
    return;
  }
  const Pad& p = pads_[pad];
  const SoilConstants& soil = loaded_.soil();
  const Vec3d u = motion.rotation * p.along, v = motion.rotation * p.across, up = cross(u, v);
  const Vec3d centre = motion.toWorld(p.centre);
  std::array<double, kPieces> pressed{}, touching{};
  std::array<Vec3d, kPieces> moment{}; // first moments of the normal forces, in the plane of the pad [N m]
  auto former = last.contacts.begin();
  const auto formerEnd = last.contacts.end();
  for (Contact& c : now_[pad]) {
    while (former != formerEnd && std::pair(former->j, former->i) < std::pair(c.j, c.i)) release(*former++, energy);
    const bool isKnown = former != formerEnd && former->j == c.j && former->i == c.i;
    c.pressure = scm::press(c, isKnown ? &*former : nullptr, loaded_, energy);
    if (isKnown) ++former;
    if (!(c.pressure > 0)) continue;
    // Damping acts during compression only.
    const Vec3d arm = u * c.u + v * c.v, place = centre + arm;
    const double sinking = std::max(0.0, -dot(motion.velocityAt(place), up));
    const double force = c.face * (c.pressure + soil.damping * sinking);
    energy.damping += c.face * soil.damping * sinking * sinking * timeStep;
    const auto k = static_cast<std::size_t>(c.piece);
    pressed[k] += c.face * c.pressure, touching[k] += c.face;
    moment[k] += arm * (c.face * c.pressure);
    load.force += up * force, load.torque += cross(place - motion.centre, up * force);
    load.pressed += force, load.area += c.face, load.sinkage = std::max(load.sinkage, c.depth);
  }
  while (former != formerEnd) release(*former++, energy);

  const double K = soil.shearDisplacement;
  std::array<double, kPieces> slipped{}; // shear displacement of the step [m]
  for (std::size_t k = 0; k < pressed.size(); ++k) {
    Shear& s = last.shear[k];
    const double before = last.strength[k], strength = strengths_[pad].of(touching[k], pressed[k]);
    const Vec3d place = pressed[k] > 0 ? moment[k] * (1 / pressed[k]) : Vec3d{};
    if (last.isThere && before > 0 && strength > 0) {
      s = turned(s, last.u, last.v, u, v);
      const double pu = dot(place, u), pv = dot(place, v);
      const Vec3d moved = centre + place - (last.centre + last.u * pu + last.v * pv);
      const double x = dot(moved, u), y = dot(moved, v);
      const ShearWork w = advance(s, x, y, K);
      slipped[k] = ::sqrt(x * x + y * y);
      energy.shear += before * w.loss;
      energy.coupling -= 0.5 * K * s.square() * (strength - before);
    } else {
      energy.edges += 0.5 * K * s.square() * before; // contact lost
      s = {};
    }
    last.strength[k] = strength, last.area[k] = touching[k];
    energy.elasticShear += 0.5 * K * s.square() * strength;
    const Vec3d force = (u * s.x + v * s.y) * -strength;
    load.force += force, load.torque += cross(centre + place - motion.centre, force);
  }
  resistAside(pad, motion, energy);
  last.u = u, last.v = v, last.centre = centre, last.isThere = true, last.touches = load.pressed > 0;
  std::swap(last.contacts, now_[pad]);
  for (const Contact& c : last.contacts)
    if (c.pressure > 0) loaded_.slip(c.loaded, slipped[static_cast<std::size_t>(c.piece)]);
}

/// Sides that push soil: the resistance is mobilised with the lateral displacement as the shear stress is.
void PadContacts::resistAside(std::size_t pad, const contact::PartMotion& motion, SoilEnergy& energy) {
  const Pad& p = pads_[pad];
  Last& last = last_[pad];
  PadLoad& load = loads_[pad];
  if (!p.grousers) return;
  const double K = loaded_.soil().shearDisplacement, beside = p.halfWidth + 2 * map_.spacing();
  const Vec3d v = motion.rotation * p.across, centre = motion.toWorld(p.centre);
  for (std::size_t k = 0; k < 2; ++k) {
    const double side = k == 0 ? 1 : -1, before = last.sideStrength[k];
    double strength = 0;
    if (load.pressed > 0) {
      const Vec3d edge = centre + v * (side * p.halfWidth), rim = centre + v * (side * beside);
      strength = sides_.at(map_.surfaceAt(rim.x, rim.y) - edge.z) * 2 * p.halfLength;
    }
    Shear s{last.side[k], 0};
    if (last.isThere && before > 0 && strength > 0) {
      const Vec3d moved = centre + v * (side * p.halfWidth) - (last.centre + last.v * (side * p.halfWidth));
      const double held = s.square(), outward = side * dot(moved, v);
      const ShearWork w = advance(s, outward, 0, K);
      if (s.x < 0) // a gap opens
        s.x = 0, energy.shear += before * 0.5 * K * held;
      else
        energy.shear += before * w.loss;
      energy.coupling -= 0.5 * K * s.square() * (strength - before);
    } else {
      energy.edges += 0.5 * K * s.square() * before;
      s = {};
    }
    last.side[k] = s.x, last.sideStrength[k] = strength;
    energy.elasticShear += 0.5 * K * s.square() * strength;
    const Vec3d force = v * (-side * s.x * strength);
    load.force += force, load.torque += cross(centre + v * (side * p.halfWidth) - motion.centre, force);
  }
}

void PadContacts::save(NumberStream& numbers) const {
  std::vector<Last> all = last_;
  stream(numbers, all);
}
void PadContacts::restore(NumberStream& numbers) { stream(numbers, last_); }

void PadContacts::stream(NumberStream& numbers, std::vector<Last>& all) const {
  for (Last& last : all) {
    numbers(last.isThere, last.touches, last.u, last.v, last.centre);
    for (std::size_t k = 0; k < kPieces; ++k)
      numbers(last.shear[k].x, last.shear[k].y, last.strength[k], last.area[k]);
    for (std::size_t k = 0; k < 2; ++k) numbers(last.side[k], last.sideStrength[k]);
    streamContacts(numbers, last.contacts, map_, [&](Contact& c) { numbers(c.piece, c.u, c.v, c.pressure); });
  }
}

} // namespace grouser::scm
