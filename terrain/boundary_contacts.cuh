// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/for_each.cuh"
#include "terrain/feet_search.hpp"
#include "terrain/grain_kernel_data.cuh"

#include <type_traits>

namespace grouser::terrain {

/// Forces of walls, floor and surfaces on the grains near them. A separate kernel, because the foot search on the floor
/// requires many registers and only one layer of grains needs it.
template <unsigned kFeatures, class Real> struct BoundaryContacts : GrainKernel<kFeatures, Real> {
  static constexpr double kNanoseconds = 100;
  using Kernel = GrainKernel<kFeatures, Real>;
  using Kernel::d, Kernel::f, Kernel::has;
  using Vec = base::Vec3<Real>;
  using Accumulator = WallAccumulator;
  using Load =
      std::conditional_t<(kFeatures & contact::kMeasured) != 0, MeasuredBoundaryLoad<Real>, BoundaryLoad<Real>>;

  /// Grain near a boundary.
  struct Grain {
    int place; ///< index in the list
    base::Vec3d x;
    Vec v, w;
    GrainSize<Real> size;
    std::uint32_t before; ///< boundaries in contact in the last step
  };
  /// Dissipation by dashpots, sliding, rolling resistance, stiffness changes and plastic work [J].
  struct Losses {
    Real damped = 0, rubbed = 0, rolled = 0, slipped = 0, yielded = 0;
  };
  struct Reaction {
    Vec force, rolling; ///< force on the grain [N], torque of rolling resistance [N m]
  };

  GROUSER_HD void operator()(int k) const {
    WallAccumulator accumulator;
    run(k, accumulator);
  }

  /// Computes the load of list entry k; adds work and impulses of walls and floor to `accumulator`.
  GROUSER_HD Load run(int k, WallAccumulator& accumulator) const {
    if (Kernel::ended()) return {};
    const int i = static_cast<int>(d.nearBoundary[k]);
    const Vec4f velocity = d.motion[i].velocity;
    const Vec v = velocity.xyz().template as<Real>(), w = d.motion[i].spin.xyz().template as<Real>();
    const base::Vec3d x = base::toUnits(d.position[i]).template as<double>() * d.unitLength;
    const Grain grain{k, x, v, w, Kernel::sizeOf(i), d.boundaryContactMask[i]};
    // Only surfaces act on a fixed grain; the ground supports it.
    const bool held = has(kSurfaces) && isFixed(velocity);
    const double radius = static_cast<double>(grain.size.radius);
    Load sum{};
    Losses lost;
    std::uint32_t now = 0;
    for (int b = 0; !held && b < d.wallCount; ++b) {
      const double distance = dot(d.walls[b].normal, x) - d.walls[b].offset;
      const Real overlap = static_cast<Real>(radius - distance);
      if (overlap <= 0) continue;
      now |= 1u << b;
      touchFixed(grain, b, d.walls[b].normal.template as<Real>(), overlap, sum, lost);
    }
    if (!held && has(kFloor) && d.floor.marks) {
      now |= touchHollows(grain, radius, sum, lost);
    } else if (!held && has(kFloor) && !d.floor.clearOf(x, radius)) {
      const FootPoint foot = d.floor.closestPoint(x);
      const Real overlap = static_cast<Real>(radius - foot.distance);
      if (overlap > 0) {
        now |= 1u << d.wallCount;
        touchFixed(grain, d.wallCount, foot.normal.template as<Real>(), overlap, sum, lost);
      }
    }
    if (now != 0) accountWalls(grain, sum, accumulator);
    if (has(kSurfaces)) now |= touchSurfaces(k, grain, sum, lost);
    if (held && now != 0) accountFixedGrain(grain, d.fromSurfaces[k], sum, accumulator);
    if (now != 0) accountDissipation(lost, accumulator);
    if (has(contact::kPlastic) && d.ledgerSums) addRare(d, i, kPlasticDissipation, static_cast<double>(lost.yielded));
    if (now != grain.before) d.boundaryContactMask[i] = now;
    f.boundaryLoads[k] = sum;
    return sum;
  }

private:
  /// Accounts for the force of walls and floor and its torque about the world origin.
  GROUSER_HD void accountWalls(const Grain& grain, const BoundaryLoad<Real>& sum, WallAccumulator& accumulator) const {
    const base::Vec3d force = sum.force.template as<double>();
    const base::Vec3d torque = cross(grain.x, force) + sum.torque.template as<double>();
    accumulator.addForce(force, torque, d.ledgerScale);
  }

  /// Accounts for the ground reaction to the load of surfaces on a fixed grain.
  GROUSER_HD void accountFixedGrain(const Grain& grain, const base::Vec3d& pressed, const BoundaryLoad<Real>& sum,
                                    WallAccumulator& accumulator) const {
    accumulator.addForce(-pressed, -(cross(grain.x, pressed) + sum.torque.template as<double>()), d.ledgerScale);
  }

  GROUSER_HD void accountDissipation(const Losses& lost, WallAccumulator& accumulator) const {
    const double q = d.ledgerScale.perEnergy;
    accumulator.add(kDashpotDissipation, wholeQuanta(q * static_cast<double>(lost.damped)));
    if (has(contact::kFriction))
      accumulator.add(kSlidingDissipation, wholeQuanta(q * static_cast<double>(lost.rubbed)));
    if (has(contact::kRollingFriction))
      accumulator.add(kRollingDissipation, wholeQuanta(q * static_cast<double>(lost.rolled)));
    if (has(contact::kFriction) && has(contact::kHertz))
      accumulator.add(kMicroSlipDissipation, wholeQuanta(q * static_cast<double>(lost.slipped)));
  }

  /// `share`: factor of dashpots and cohesion, if the contact is one of several merged feet [-].
  GROUSER_HD void touchFixed(const Grain& grain, int boundary, const Vec& outward, Real overlap, Load& sum,
                             Losses& lost, Real share = 1) const {
    const Vec normal = -outward; // from the grain to the wall
    const Vec arm = normal * (grain.size.radius - overlap);
    const contact::BasicContactGeometry<Real> touch{
        normal, overlap, grain.v + cross(grain.w, arm), grain.size.mass, grain.size.radius, share, share};
    const Reaction reaction = react(grain, boundary, touch, grain.w, nullptr, sum, lost);
    sum.force += reaction.force;
    measure(sum, reaction.force, arm);
    if (has(contact::kFriction)) sum.torque += cross(arm, reaction.force);
    if (has(contact::kRollingFriction)) sum.torque += reaction.rolling;
  }

  /// Computes contacts with a floor that has hollows tighter than the grain; each contact has its own springs.
  GROUSER_HD std::uint32_t touchHollows(const Grain& grain, double radius, Load& sum, Losses& lost) const {
    if (d.floor.clearOf(grain.x, radius)) return 0;
    float* normals = Kernel::hasHistory() ? d.floorNormals(grain.place, Kernel::historyWidth()) : nullptr;
    const PlacedFeet placed(d.floor, grain.x, radius, grain.before >> d.wallCount, normals);
    const Feet& feet = placed.feet;
    const FeetLoads loads(feet, radius, Kernel::boundaryLaw(d.wallCount, grain.size.material).hertz);
    Grain here = grain;
    here.before = placed.goOn << d.wallCount;
    std::uint32_t now = 0;
    for (int k = 0; k < feet.count; ++k) {
      const Real overlap = static_cast<Real>(loads.overlap(k));
      if (overlap <= 0) continue;
      const Vec normal = feet.foot[k].normal.template as<Real>();
      now |= 1u << (d.wallCount + placed.place[k]);
      touchFixed(here, d.wallCount + placed.place[k], normal, overlap, sum, lost, static_cast<Real>(loads.share(k)));
      const Real deep = static_cast<Real>(radius - feet.foot[k].distance);
      sum.deepest = deep > sum.deepest ? deep : sum.deepest;
      if (normals) storeVector(normals + 3 * placed.place[k], feet.foot[k].normal.template as<float>());
    }
    return now;
  }

  /// Computes contacts with moving surfaces. Forces on the grain are whole quanta; the surface receives the opposite.
  GROUSER_HD std::uint32_t touchSurfaces(int k, const Grain& grain, Load& sum, Losses& lost) const {
    std::uint32_t now = 0;
    base::Vec3d force;
    const int first = d.boundaryCount - d.surfaceCount;
    for (int s = 0; s < d.surfaceCount; ++s) {
      const contact::PartMotion& motion = d.placements[s].motion;
      const SurfaceGap gap = gapTo(d.surfaces[s], motion.toPart(grain.x));
      const Real overlap = static_cast<Real>(static_cast<double>(grain.size.radius) - gap.distance);
      if (overlap <= 0) continue;
      const int boundary = first + s;
      now |= 1u << boundary;
      const Vec normal = (motion.rotation * -gap.normal).template as<Real>();
      const Vec arm = normal * (grain.size.radius - overlap);
      const base::Vec3d point = grain.x + arm.template as<double>();
      const Vec velocity = grain.v + cross(grain.w, arm) - motion.velocityAt(point).template as<Real>();
      const contact::BasicContactGeometry<Real> touch{normal, overlap, velocity, grain.size.mass, grain.size.radius};
      const Reaction reaction =
          react(grain, boundary, touch, grain.w - motion.spin.template as<Real>(), &d.placements[s].turned, sum, lost);
      const base::Vec3l quanta = d.surfaceForce.quantise(reaction.force.template as<double>());
      const base::Vec3d exact = d.surfaceForce.value(quanta);
      force += exact;
      measure(sum, exact.template as<Real>(), arm);
      if (has(contact::kFriction)) sum.torque += cross(arm, exact.template as<Real>());
      base::Vec3d torque = cross(point - motion.centre, -exact);
      if (has(contact::kRollingFriction)) {
        sum.torque += reaction.rolling;
        torque -= reaction.rolling.template as<double>();
      }
      Kernel::loadSurface(s, quanta, torque);
    }
    d.fromSurfaces[k] = force;
    return now;
  }

  /// Computes one contact; spring displacements are in world axes, or in axes rotated by `turned` since the start.
  GROUSER_HD Reaction react(const Grain& grain, int boundary, const contact::BasicContactGeometry<Real>& touch,
                            const Vec& spin, const base::Mat3d* turned, Load& sum, Losses& lost) const {
    const contact::BasicLaw<Real>& law = Kernel::boundaryLaw(boundary, grain.size.material);
    const bool held = Kernel::hasHistory() && (grain.before >> boundary & 1);
    float* history = Kernel::hasHistory() ? d.historyOf(grain.place, boundary, Kernel::historyWidth()) : nullptr;
    Vec shear{};
    if (held) shear = turnedSpring<Real>(history, turned);
    contact::BasicPlasticState<Real> plastic{};
    if (has(contact::kPlastic) && held) plastic = loadPlastic<Real>(Kernel::plasticIn(history));
    const auto reaction =
        contact::contactForce<Kernel::kLaw>(law, touch, f.timeStep, shear, has(contact::kPlastic) ? &plastic : nullptr);
    if (Kernel::hasHistory()) storeTurned(history, turned, shear);
    if (has(contact::kPlastic)) storePlastic(Kernel::plasticIn(history), plastic);
    lost.damped += reaction.damped, lost.rubbed += reaction.rubbed, lost.yielded += reaction.yielded;
    if (has(contact::kHertz)) lost.slipped += reaction.slipped;
    Reaction result{reaction.force, {}};
    if (has(contact::kRollingFriction)) {
      Vec angle{};
      if (held) angle = turnedSpring<Real>(history + 3, turned);
      const contact::RollingMotion<Real> motion{touch.normal, spin, grain.size.radius,
                                                contact::rollingInertia(grain.size.mass, grain.size.radius)};
      result.rolling = contact::rollingTorque(law, motion, reaction.pressing, reaction.normalStiffness, f.timeStep,
                                              angle, lost.rolled, has(contact::kHertz) ? &reaction.change : nullptr);
      storeTurned(history + 3, turned, angle);
    }
    if (touch.overlap > sum.deepest) sum.deepest = touch.overlap;
    return result;
  }

  GROUSER_HD static void measure(Load& sum, const Vec& force, const Vec& arm) {
    if constexpr ((kFeatures & contact::kMeasured) != 0)
      sum.moment.add(force.template as<double>(), arm.template as<double>());
  }
};

} // namespace grouser::terrain
