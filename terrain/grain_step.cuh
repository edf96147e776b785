// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/for_each.cuh"
#include "contact/grain_loads.hpp"
#include "contact/neighbour_list.hpp"
#include "terrain/grain_model.hpp"
#include "terrain/grain_records.hpp"

namespace grouser::terrain {

/// Everything the step needs, by value.
struct GrainKernelData {
  // Constants.
  float radius, diameter, unit, timeStep, halfMass, mass;
  std::int64_t diameterUnits, diameterUnits2, halfSkinUnits2;
  double stepPerMass, stepPerInertia, unitsPerSpeed; // dt/m, dt/I, dt/unit
  double unitLength;
  float maxOverlap, maxSpeed2;
  base::Vec3d gravityStep; // g dt
  contact::LinearLaw law, floorLaw;
  const Wall* walls;
  int wallCount, boundaryCount; ///< planes; planes and floor together
  bool hasFloor;
  HeightFieldView floor;
  std::int64_t count;          ///< slots
  const std::uint32_t* active; ///< slots that this launch is for; null: all

  // State. Positions, velocities and spins are read from `now` and written to `next`: neighbours still read `now`.
  const base::Position* position;
  const Vec4f *velocity, *spin;
  base::Position* nextPosition;
  Vec4f *nextVelocity, *nextSpin;
  Remainders* remainders;
  const std::uint32_t* id;
  const base::Vec3<std::uint32_t>* reference; ///< low words of the positions at the last rebuild
  contact::NeighbourView neighbours;
  const std::uint32_t* nearBoundary; ///< slots of the grains that may touch walls or floor before the next rebuild
  const std::uint32_t* boundaryOf;   ///< by slot: 1 + place in that list, 0 for all others
  BoundaryLoad* boundaryLoads;       ///< by place in that list
  base::Vec3f* wallShear;            ///< [slot][wall or floor]
  std::uint32_t* wallTouching;       ///< bit a wall, bit `wallCount` the floor
  double* dissipated;
  contact::GrainLoadsView loads;
  StepFlags* flags;
};

/// Walls and floor on the grains near them. A kernel of its own: the search on the floor needs many registers, and only
/// one layer of grains needs the search.
template <bool kFriction> struct BoundaryContacts {
  GrainKernelData d;

  GROUSER_HD void operator()(int k) const {
    const int i = static_cast<int>(d.nearBoundary[k]);
    const base::Vec3f v = d.velocity[i].xyz(), w = d.spin[i].xyz();
    const base::Vec3d x = base::toUnits(d.position[i]).as<double>() * d.unitLength;
    BoundaryLoad sum{};
    const std::uint32_t before = d.wallTouching[i];
    std::uint32_t now = 0;
    for (int b = 0; b < d.wallCount; ++b) {
      const double distance = dot(d.walls[b].normal, x) - d.walls[b].offset;
      const float overlap = static_cast<float>(static_cast<double>(d.radius) - distance);
      if (overlap <= 0) continue;
      now |= 1u << b;
      touchBoundary(i, b, before, d.walls[b].law, d.walls[b].normal.as<float>(), overlap, v, w, sum);
    }
    if (d.hasFloor && !d.floor.clearOf(x, d.radius)) {
      const FootPoint foot = d.floor.closestPoint(x);
      const float overlap = static_cast<float>(static_cast<double>(d.radius) - foot.distance);
      if (overlap > 0) {
        now |= 1u << d.wallCount;
        touchBoundary(i, d.wallCount, before, d.floorLaw, foot.normal.as<float>(), overlap, v, w, sum);
      }
    }
    if (now != before) d.wallTouching[i] = now;
    d.boundaryLoads[k] = sum;
  }

private:
  GROUSER_HD void touchBoundary(int i, int boundary, std::uint32_t before, const contact::LinearLaw& law,
                                const base::Vec3f& outward, float overlap, const base::Vec3f& v, const base::Vec3f& w,
                                BoundaryLoad& sum) const {
    const base::Vec3f normal = -outward; // from the grain to the wall
    const base::Vec3f arm = normal * (d.radius - overlap);
    contact::Touch touch{normal, overlap, v + cross(w, arm), d.mass};
    base::Vec3f shear{};
    const std::int64_t at = static_cast<std::int64_t>(i) * d.boundaryCount + boundary;
    if (kFriction && (before >> boundary & 1)) shear = d.wallShear[at];
    const contact::Reaction reaction = contact::linearForce(law, touch, d.timeStep, shear);
    if (kFriction) d.wallShear[at] = shear;
    sum.force += reaction.force;
    if (kFriction) sum.torque += cross(arm, reaction.force);
    sum.dissipated += reaction.dissipated;
    if (overlap > sum.deepest) sum.deepest = overlap;
  }
};

/// One grain, one step: gather its contacts in the order of the neighbours' ids, then advance it by symplectic Euler.
/// The scene's features are template parameters, so that what is absent costs nothing.
template <bool kFriction, bool kBoundaries, bool kLoads, bool kLedger> struct GrainStep {
  GrainKernelData d;

  struct Sum {
    base::Vec3f force, torque;
    float dissipated = 0, deepest = 0;
  };

  GROUSER_HD void operator()(int k) const {
    const int i = d.active ? static_cast<int>(d.active[k]) : k;
    Sum sum;
    const base::Position p = d.position[i];
    const base::Vec3f v = d.velocity[i].xyz(), w = d.spin[i].xyz();
    gatherGrains(i, p, v, w, sum);
    if (kBoundaries) addBoundaries(i, sum);
    base::Vec3d force = sum.force.template as<double>(), torque = sum.torque.template as<double>();
    if (kLoads) addLoads(i, force, torque, sum);
    if (kLedger) d.dissipated[i] += static_cast<double>(sum.dissipated);
    advance(i, p, v, w, force, torque, sum.deepest);
  }

private:
  GROUSER_HD void gatherGrains(int i, const base::Position& p, const base::Vec3f& v, const base::Vec3f& w,
                               Sum& sum) const {
    const std::uint32_t n = d.neighbours.count[i];
    const std::uint64_t before = d.neighbours.touching[i];
    std::uint64_t now = 0;
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::int64_t at = d.neighbours.at(i, k);
      const std::uint32_t j = d.neighbours.slot[at];
      const base::Vec3i apart = base::difference(p, d.position[j]);
      const std::int64_t distance2 = base::squaredNorm(apart);
      if (distance2 >= d.diameterUnits2) continue;
      if (distance2 == 0) { // no direction to push in: the overlap alarm
        sum.deepest = d.diameter;
        continue;
      }
      now |= std::uint64_t{1} << k;
      // (D^2 - d^2) / (D + d) from exact integers: no cancellation.
      const float distance = sqrtf(static_cast<float>(distance2));
      const float overlap =
          static_cast<float>(d.diameterUnits2 - distance2) / (static_cast<float>(d.diameterUnits) + distance) * d.unit;
      const base::Vec3f normal = apart.as<float>() * (1.0f / distance);
      // Both lever arms meet in the middle, so angular momentum balances too.
      const float arm = 0.5f * distance * d.unit;
      contact::Touch touch{normal, overlap, v - d.velocity[j].xyz(), d.halfMass};
      touch.velocity += cross(w + d.spin[j].xyz(), normal * arm);
      base::Vec3f shear{};
      if (kFriction && (before >> k & 1)) shear = d.neighbours.shear[at];
      const contact::Reaction reaction = contact::linearForce(d.law, touch, d.timeStep, shear);
      if (kFriction) d.neighbours.shear[at] = shear;
      sum.force += reaction.force;
      if (kFriction) sum.torque += cross(normal * arm, reaction.force);
      sum.dissipated += 0.5f * reaction.dissipated; // the other half is the neighbour's
      if (overlap > sum.deepest) sum.deepest = overlap;
    }
    d.neighbours.touching[i] = now;
  }

  GROUSER_HD void addBoundaries(int i, Sum& sum) const {
    const std::uint32_t place = d.boundaryOf[i];
    if (place == 0) return;
    const BoundaryLoad& load = d.boundaryLoads[place - 1];
    sum.force += load.force;
    sum.torque += load.torque;
    sum.dissipated += load.dissipated;
    if (load.deepest > sum.deepest) sum.deepest = load.deepest;
  }

  /// Forces from rigid parts come as integers and are added as such: the parts receive exactly their opposite.
  GROUSER_HD void addLoads(int i, base::Vec3d& force, base::Vec3d& torque, Sum& sum) const {
    const std::uint32_t range = d.loads.range[i];
    if (range == 0) return;
    base::Vec3l quanta{};
    const std::uint32_t first = range >> 8, count = range & 255u;
    for (std::uint32_t k = 0; k < count; ++k) {
      const contact::GrainLoad& load = d.loads.load[first + k];
      quanta += load.force;
      torque += load.torque.template as<double>();
      sum.dissipated += load.dissipated;
      // Stones do get caught between tooth and track: a part may press a grain deeper than grains may press each other,
      // but not to its middle.
      if (load.deepest > d.radius) sum.deepest = load.deepest;
    }
    force += d.loads.force.value(quanta);
    for (int a = 0; a < 3; ++a) base::atomicAdd64(d.loads.received + a, quanta[a]);
  }

  /// v += a dt, x += v dt, w += alpha dt, each with its remainder kept.
  GROUSER_HD void advance(int i, const base::Position& p, base::Vec3f v, base::Vec3f w, const base::Vec3d& force,
                          const base::Vec3d& torque, float deepest) const {
    Remainders kept = d.remainders[i];
    base::Vec3l moved = base::toUnits(p);
    for (int a = 0; a < 3; ++a) {
      std::int16_t rv = lowRemainder(kept.axis[a]), rw = highRemainder(kept.axis[a]);
      const double speed = addKeeping(v[a], rv, force[a] * d.stepPerMass + d.gravityStep[a]);
      if (kFriction || kLoads) addKeeping(w[a], rw, torque[a] * d.stepPerInertia);
      kept.axis[a] = packRemainders(rv, rw);
      const double displacement = speed * d.unitsPerSpeed;
      // A speed that is no number must not reach the integer conversion.
      if (displacement > -1e9 && displacement < 1e9) moved[a] += advanceKeeping(displacement, kept.position, a);
    }
    const base::Position q = base::fromUnits(moved);
    d.nextPosition[i] = q;
    d.nextVelocity[i] = {v.x, v.y, v.z, 0};
    d.nextSpin[i] = {w.x, w.y, w.z, 0};
    d.remainders[i] = kept;

    const base::Vec3<std::uint32_t> r = d.reference[i];
    const base::Vec3i travelled{static_cast<std::int32_t>(q.x - r.x), static_cast<std::int32_t>(q.y - r.y),
                                static_cast<std::int32_t>(q.z - r.z)};
    if (base::squaredNorm(travelled) > d.halfSkinUnits2) base::raise(&d.flags->stale);

    const float speed2 = dot(v, v);
    Fault fault = Fault::none;
    constexpr std::int64_t kRange = std::int64_t{1} << 41;
    const bool inside = moved.x >= -kRange && moved.x < kRange && moved.y >= -kRange && moved.y < kRange &&
                        moved.z >= -kRange && moved.z < kRange;
    if (!(speed2 < 1e30f))
      fault = Fault::notANumber;
    else if (!inside)
      fault = Fault::range;
    else if (deepest > d.maxOverlap)
      fault = Fault::overlap;
    else if (speed2 > d.maxSpeed2)
      fault = Fault::speed;
    if (fault != Fault::none) base::atomicMin64(&d.flags->fault, static_cast<std::uint64_t>(fault) << 56 | d.id[i]);
  }
};

} // namespace grouser::terrain
