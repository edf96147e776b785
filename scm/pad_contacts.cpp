// SPDX-License-Identifier: BSD-3-Clause
#include "scm/pad_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::scm {

namespace {

/// Fraction of a node's square inside a pad along one axis; `perWidth`: 1 / width of the square along that axis [1/m].
double shareOf(double place, double half, double perWidth) {
  return std::clamp((half - std::fabs(place)) * perWidth + 0.5, 0.0, 1.0);
}
/// Index of the piece along one axis; `perHalf`: pieces per half side [1/m].
int pieceOf(double place, double half, double perHalf, int count) {
  return std::clamp(static_cast<int>((place + half) * perHalf), 0, count - 1);
}

/// Rotates the stress s of the last step into the current plane of the pad, preserving its magnitude.
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

/// Width b of each pad. In a track it is the smaller of the pad width and the length of the run of pads in contact; the
/// run includes the pad, even if this pad is not in contact yet.
void PadContacts::updateBreadths() {
  for (std::size_t first = 0, end = 0; first < pads_.size(); first = end) {
    for (end = first + 1; end < pads_.size() && pads_[first].track >= 0 && pads_[end].track == pads_[first].track;)
      ++end;
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
  // Widths of a node's square along the pad's axes.
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
  if (now_[pad].empty() && last.contacts.empty() && !last.touches) return;
  const Pad& p = pads_[pad];
  const Pose pose{motion.rotation * p.along, motion.rotation * p.across, motion.toWorld(p.centre)};
  const Pieces pieces = pressNodes(pad, motion, pose, timeStep, energy);
  shearPieces(pad, motion, pose, pieces, timeStep, energy);
  if (p.grousers) resistAside(pad, motion, pose, energy);
  last.pose = pose, last.touches = load.pressed > 0;
  std::swap(last.contacts, now_[pad]);
}

PadContacts::Pieces PadContacts::pressNodes(std::size_t pad, const contact::PartMotion& motion, const Pose& pose,
                                            double timeStep, SoilEnergy& energy) {
  Pieces pieces;
  PadLoad& load = loads_[pad];
  const double damping = loaded_.soil().damping;
  const Vec3d up = pose.up();
  FormerContacts<Contact> former(last_[pad].contacts);
  const auto ended = [&](const Contact& c) { release(c, energy); };
  for (Contact& c : now_[pad]) {
    c.pressure = scm::press(c, former.match(c, ended), loaded_, energy);
    if (!(c.pressure > 0)) continue;
    // Damping acts during compression only.
    const Vec3d arm = pose.u * c.u + pose.v * c.v, place = pose.centre + arm;
    const double sinking = std::max(0.0, -dot(motion.velocityAt(place), up));
    const double force = c.face * (c.pressure + damping * sinking);
    energy.damping += c.face * damping * sinking * sinking * timeStep;
    const auto k = static_cast<std::size_t>(c.piece);
    pieces.pressed[k] += c.face * c.pressure, pieces.touching[k] += c.face;
    pieces.moment[k] += arm * (c.face * c.pressure);
    load.force += up * force, load.torque += cross(place - motion.centre, up * force);
    load.pressed += force, load.area += c.face, load.sinkage = std::max(load.sinkage, c.depth);
  }
  former.finish(ended);
  return pieces;
}

void PadContacts::shearPieces(std::size_t pad, const contact::PartMotion& motion, const Pose& pose,
                              const Pieces& pieces, double timeStep, SoilEnergy& energy) {
  Last& last = last_[pad];
  PadLoad& load = loads_[pad];
  const double K = loaded_.soil().shearDisplacement;
  std::array<double, kPieces> slipped{}; // shear displacement of the step [m]
  for (std::size_t k = 0; k < slipped.size(); ++k) {
    Shear& s = last.shear[k];
    const double pressed = pieces.pressed[k], touching = pieces.touching[k];
    const double before = last.strength[k], strength = strengths_[pad].of(touching, pressed);
    const Vec3d place = pressed > 0 ? pieces.moment[k] * (1 / pressed) : Vec3d{};
    Vec3d damped;
    if (before > 0 && strength > 0) {
      s = turned(s, last.pose.u, last.pose.v, pose.u, pose.v);
      const double pu = dot(place, pose.u), pv = dot(place, pose.v);
      const Vec3d moved = pose.centre + place - (last.pose.centre + last.pose.u * pu + last.pose.v * pv);
      const double x = dot(moved, pose.u), y = dot(moved, pose.v);
      const Shear former = s;
      const double loss = advance(s, x, y, K).loss, du = s.x - former.x, dv = s.y - former.y;
      const double change = ::sqrt(du * du + dv * dv);
      damped = (pose.u * du + pose.v * dv) * shearDamping(loaded_.soil(), timeStep, touching, strength, change);
      energy.damping += dot(damped, moved);
      slipped[k] = ::sqrt(x * x + y * y);
      addShear(energy, K, before, strength, s.square(), loss);
    } else {
      releaseShear(energy, K, before, s.square());
      s = {};
    }
    last.strength[k] = strength, last.area[k] = touching;
    const Vec3d force = (pose.u * s.x + pose.v * s.y) * -strength - damped;
    load.force += force, load.torque += cross(pose.centre + place - motion.centre, force);
  }
  for (const Contact& c : now_[pad])
    if (c.pressure > 0) loaded_.slip(c.loaded, slipped[static_cast<std::size_t>(c.piece)]);
}

/// Computes the bulldozing sides: the resistance is mobilised with the lateral displacement like the shear stress.
void PadContacts::resistAside(std::size_t pad, const contact::PartMotion& motion, const Pose& pose,
                              SoilEnergy& energy) {
  const Pad& p = pads_[pad];
  Last& last = last_[pad];
  PadLoad& load = loads_[pad];
  const double K = loaded_.soil().shearDisplacement, beside = p.halfWidth + 2 * map_.spacing();
  for (std::size_t k = 0; k < 2; ++k) {
    const double side = k == 0 ? 1 : -1, before = last.sideStrength[k];
    const Vec3d edge = pose.centre + pose.v * (side * p.halfWidth);
    double strength = 0;
    if (load.pressed > 0) {
      const Vec3d rim = pose.centre + pose.v * (side * beside);
      strength = sides_.at(map_.surfaceAt(rim.x, rim.y) - edge.z) * 2 * p.halfLength;
    }
    Shear s{last.side[k], 0};
    const double held = s.square();
    if (before > 0 && strength > 0) {
      const Vec3d moved = edge - (last.pose.centre + last.pose.v * (side * p.halfWidth));
      double loss = advance(s, side * dot(moved, pose.v), 0, K).loss;
      if (s.x < 0) s.x = 0, loss = 0.5 * K * held; // a gap opens
      addShear(energy, K, before, strength, s.square(), loss);
    } else {
      releaseShear(energy, K, before, held);
      s = {};
    }
    last.side[k] = s.x, last.sideStrength[k] = strength;
    const Vec3d force = pose.v * (-side * s.x * strength);
    load.force += force, load.torque += cross(edge - motion.centre, force);
  }
}

void PadContacts::save(NumberStream& numbers) const {
  std::vector<Last> all = last_;
  stream(numbers, all);
}
void PadContacts::restore(NumberStream& numbers) { stream(numbers, last_); }

void PadContacts::stream(NumberStream& numbers, std::vector<Last>& all) const {
  for (Last& last : all) {
    numbers(last.touches, last.pose.u, last.pose.v, last.pose.centre);
    for (std::size_t k = 0; k < kPieces; ++k) numbers(last.shear[k].x, last.shear[k].y, last.strength[k], last.area[k]);
    for (std::size_t k = 0; k < 2; ++k) numbers(last.side[k], last.sideStrength[k]);
    streamContacts(numbers, last.contacts, map_, [&](Contact& c) { numbers(c.piece, c.u, c.v, c.pressure); });
  }
}

} // namespace grouser::scm
