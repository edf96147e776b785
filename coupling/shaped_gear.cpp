// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/shaped_gear.hpp"

#include "vehicle/gap_profile.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::coupling {

using base::Vec3d;
using contact::PartMotion;

namespace {

Vec3d column(const base::Mat3d& m, int i) { return {m.m[0][i], m.m[1][i], m.m[2][i]}; }

/// Minimum cosine of the angle between the y axis of a shoe and a wheel axis for contact.
constexpr double kMinTurn = 0.5;

/// Upper bound by which misalignment shortens the distance to a wheel axis, at the lateral offset `across` [m] from the
/// shoe's middle. `turn`: cosine of the angle between the axes.
double slackOf(double turn, double across, double radius) {
  return across * std::sqrt(std::max(1 - turn * turn, 0.0)) / turn + radius * (1 / turn - 1);
}

void put(contact::Vec3P& to, std::size_t lane, const Vec3d& v) { to.x[lane] = v.x, to.y[lane] = v.y, to.z[lane] = v.z; }

} // namespace

ShapedGear::ShapedGear(const vehicle::Assembly& assembly, const VehicleParts& parts, const Model& model)
    : law_(model.law), shapes_(*assembly.spec.shapes), halfLength_(assembly.spec.shoe.halfLength),
      plateTop_(assembly.spec.shoe.plateTop), hornHeight_(assembly.spec.shoe.hornHeight),
      pin_(0.5 * assembly.spec.shoe.pitch), gap_(vehicle::gapProfile(assembly.spec)), tracks_(assembly.tracks.size()),
      patches_(model.quanta, model.timeStep, assembly.pairs.size() * kPatches) {
  using vehicle::PartKind;
  for (std::size_t p = 0; p < assembly.parts.size(); ++p) {
    const vehicle::Part& part = assembly.parts[p];
    if (part.kind == PartKind::kChassis) continue;
    Track& track = tracks_[static_cast<std::size_t>(part.track)];
    const int contactPart = parts.contactIndex(static_cast<int>(p));
    if (part.kind == PartKind::kShoe) {
      track.shoes.push_back(contactPart);
      continue;
    }
    const vehicle::VehicleSpec& spec = assembly.spec;
    const double radius = part.kind == PartKind::kSprocket    ? shapes_.tipRadius
                          : part.kind == PartKind::kRoadWheel ? spec.roadWheel.radius
                          : part.kind == PartKind::kRoller    ? spec.roller.radius
                                                              : spec.idler.radius;
    track.gear.push_back({contactPart, radius, part.kind == PartKind::kSprocket});
  }
  // Pairs have the order of Assembly::pairs: shoe by shoe.
  std::size_t pairs = 0;
  for (Track& track : tracks_) track.firstPair = pairs, pairs += track.shoes.size() * track.gear.size();
}

void ShapedGear::compute(const PartMotion* motion, contact::PartLoad* loads) {
  motion_ = motion, loads_ = loads;
  patches_.beginStep();
  // Maximum distance between a wheel axle and the centre of a touching shoe.
  const double height = plateTop_ + hornHeight_, reach = std::sqrt(halfLength_ * halfLength_ + height * height);
  const double boss = pin_ + shapes_.bossRadius;
  for (const Track& track : tracks_)
    for (std::size_t g = 0; g < track.gear.size(); ++g) {
      const Wheel& wheel = track.gear[g];
      const double within = wheel.radius + (wheel.isSprocket ? boss : reach);
      for (std::size_t i = 0; i < track.shoes.size(); ++i) {
        const Vec3d apart = motion[track.shoes[i]].origin - motion[wheel.part].origin;
        if (!(norm2(apart) < within * within)) continue;
        const std::size_t pair = track.firstPair + i * track.gear.size() + g;
        const Near near = nearby(motion, track.shoes[i], wheel, pair * kPatches);
        if (wheel.isSprocket)
          collideSprocket(near);
        else
          collideWheel(near);
      }
    }
  pressRims();
  patches_.endStep();
}

ShapedGear::Near ShapedGear::nearby(const PartMotion* motion, int shoePart, const Wheel& of,
                                    std::size_t patches) const {
  const PartMotion &shoe = motion[shoePart], &wheel = motion[of.part];
  const Vec3d apart = shoe.centre - wheel.centre;
  return {shoe,
          wheel,
          shoePart,
          of,
          patches,
          column(shoe.rotation, 0),
          column(shoe.rotation, 1),
          column(shoe.rotation, 2),
          shoe.origin - shoe.centre,
          wheel.origin - shoe.centre,
          column(wheel.rotation, 1),
          {shoe.velocity - wheel.velocity - cross(wheel.spin, apart), shoe.spin - wheel.spin}};
}

void ShapedGear::collideWheel(const Near& near) {
  // Most nearby wheels touch only the plates. Compare height and offset of the axle with the rim radius.
  const Vec3d apart = near.axle - near.origin;
  const double x = dot(apart, near.x), radius = near.of.radius;
  const double turn = dot(near.y, near.axis);
  if (turn < kMinTurn) return;
  const double slack = slackOf(turn, shapes_.plateOuter, radius);
  const auto cuts = [&](double level, double halfLength) {
    const double above = dot(apart, near.z) - level, beyond = std::max(std::fabs(x) - halfLength, 0.0);
    const double within = radius + slack;
    return above > 0 && above * above + beyond * beyond < within * within;
  };
  const bool onPlates = cuts(plateTop_, halfLength_);
  if (onPlates) {
    collidePlate(near, plateTop_, halfLength_, -shapes_.plateOuter, -shapes_.plateInner, kPlates);
    collidePlate(near, plateTop_, halfLength_, shapes_.plateInner, shapes_.plateOuter, kPlates + 1);
  }
  const double tip = plateTop_ + hornHeight_;
  if (!onPlates && !cuts(tip, 0.5 * shapes_.hornLength)) return;
  collideHorn(near, -1, kHornSides);
  collideHorn(near, 1, kHornSides + 1);
  collidePlate(near, tip, 0.5 * shapes_.hornTipLength, -0.5 * shapes_.hornTipWidth, 0.5 * shapes_.hornTipWidth,
               kHornTip);
}

/// Contact of a rectangle of the shoe, parallel to its plates at height `level`, with the rim of the disc above it.
void ShapedGear::collidePlate(const Near& near, double level, double halfLength, double from, double to, int patch) {
  const double turn = dot(near.y, near.axis);
  const double x = std::clamp(dot(near.axle - near.origin, near.x), -halfLength, halfLength);
  const Vec3d plate = near.origin + near.z * level;
  // Flat part of the rim, in shoe coordinates.
  const double beside = dot(plate + near.x * x - near.axle, near.axis);
  const double inner = shapes_.discInner + shapes_.discChamfer, outer = shapes_.discOuter - shapes_.discChamfer;
  for (const double side : {-1.0, 1.0}) {
    const double low = side < 0 ? -outer : inner, high = side < 0 ? -inner : outer;
    const double first = std::max(from, (low - beside) / turn), last = std::min(to, (high - beside) / turn);
    if (!(last > first)) continue;
    const std::size_t lane = rimCount_++;
    put(rims_.plate, lane, plate), put(rims_.along, lane, near.x), put(rims_.across, lane, near.y);
    put(rims_.axle, lane, near.axle), put(rims_.axis, lane, near.axis);
    rims_.halfLength[lane] = halfLength, rims_.radius[lane] = near.of.radius;
    rims_.from[lane] = first, rims_.to[lane] = last;
    put(rims_.motion.velocity, lane, near.motion.velocity), put(rims_.motion.spin, lane, near.motion.spin);
    rimOf_[lane] = {near.patches + static_cast<std::size_t>(patch), near.shoePart, near.of.part};
    if (rimCount_ == contact::kPointLanes) pressRims();
    return;
  }
}

void ShapedGear::pressRims() {
  if (rimCount_ == 0) return;
  for (std::size_t l = rimCount_; l < contact::kPointLanes; ++l) {
    put(rims_.along, l, {1, 0, 0}), put(rims_.across, l, {0, 1, 0}), put(rims_.axis, l, {0, 1, 0});
    rims_.from[l] = rims_.to[l] = 0;
  }
  const contact::PressureLanes sums = contact::pressRims(law_, patches_.timeStep(), rims_);
  for (std::size_t l = 0; l < rimCount_; ++l)
    patches_.press(rimOf_[l].patch, law_, motion_, rimOf_[l].shoe, rimOf_[l].wheel, sums.lane(static_cast<int>(l)),
                   loads_);
  rimCount_ = 0;
}

void ShapedGear::collideHorn(const Near& near, double side, int patch) {
  contact::FaceAtDisc face;
  face.foot = near.origin + near.z * plateTop_ + near.y * (0.5 * side * shapes_.hornWidth);
  face.up = near.z * hornHeight_ + near.y * (0.5 * side * (shapes_.hornTipWidth - shapes_.hornWidth));
  face.axis = near.axis * side;
  face.axle = near.axle + face.axis * shapes_.discInner;
  face.along = near.x;
  face.halfFoot = 0.5 * shapes_.hornLength, face.halfTip = 0.5 * shapes_.hornTipLength;
  const double deep = dot(face.foot - face.axle, face.axis), turned = std::fabs(dot(face.along, face.axis));
  const double atFoot = deep + turned * face.halfFoot, atTip = deep + dot(face.up, face.axis) + turned * face.halfTip;
  if (atFoot <= 0 && atTip <= 0) return;
  face.radius = near.of.radius, face.chamfer = shapes_.discChamfer, face.motion = near.motion;
  patches_.press(near.patches + static_cast<std::size_t>(patch), law_, motion_, near.shoePart, near.of.part,
                 contact::pressFace(law_, patches_.timeStep(), face), loads_);
}

void ShapedGear::collideSprocket(const Near& near) {
  contact::BossInGap boss;
  boss.boss = near.origin + near.x * pin_;
  boss.alongX = near.x, boss.alongZ = near.z;
  boss.across = near.y, boss.radius = shapes_.bossRadius;
  boss.axle = near.axle, boss.axis = near.axis;
  boss.x = column(near.wheel.rotation, 0), boss.z = column(near.wheel.rotation, 2);
  boss.motion = near.motion;
  const Vec3d apart = boss.boss - near.axle;
  const double beside = dot(apart, near.axis),
               within = shapes_.tipRadius + shapes_.bossRadius + shapes_.ringOuter * std::fabs(dot(near.axis, near.x));
  if (norm2(apart) - beside * beside > within * within) return;
  const double turn = dot(near.y, near.axis);
  if (turn < 0.5) return;
  for (const double side : {-1.0, 1.0}) {
    const double ringLow = side < 0 ? -shapes_.ringOuter : shapes_.ringInner;
    const double ringHigh = side < 0 ? -shapes_.ringInner : shapes_.ringOuter;
    const double low = side < 0 ? -shapes_.bossOuter : shapes_.bossInner;
    const double high = side < 0 ? -shapes_.bossInner : shapes_.bossOuter;
    boss.from = std::max(low, (ringLow - beside) / turn), boss.to = std::min(high, (ringHigh - beside) / turn);
    if (!(boss.to > boss.from)) continue;
    const auto halves = contact::pressBoss(law_, patches_.timeStep(), gap_, boss);
    for (std::size_t half = 0; half < 2; ++half)
      patches_.press(near.patches + kBosses + (side < 0 ? 0 : 2) + half, law_, motion_, near.shoePart, near.of.part,
                     halves[half], loads_);
  }
}

} // namespace grouser::coupling
