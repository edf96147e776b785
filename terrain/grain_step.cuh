// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/bits.hpp"
#include "contact/sphere_pair.hpp"
#include "terrain/grain_kernel_data.cuh"

#include <type_traits>

namespace grouser::terrain {

/// One step of one grain: sums its contacts in the order of the neighbours' ids, then advances it by symplectic Euler.
/// The scene's features are template parameters, so absent features have no cost.
template <unsigned kFeatures, class Real> struct GrainStep : GrainKernel<kFeatures, Real> {
  static constexpr double kNanoseconds = 200;
  /// Limits a thread to 96 registers; Hertz's law would otherwise use up to 114. A few are spilled, but one more block
  /// fits on a multiprocessor.
  static constexpr int kBlocksTogether =
      std::is_same_v<Real, float> && (kFeatures & (contact::kHertz | contact::kPlastic)) == contact::kHertz ? 5 : 0;
  using Kernel = GrainKernel<kFeatures, Real>;
  using Kernel::d, Kernel::f, Kernel::has, Kernel::raise;
  using Vec = base::Vec3<Real>;
  static constexpr bool kMaySlip = kFeatures & (contact::kHertz | contact::kGeneral),
                        kMayHold = kFeatures & (kFixed | contact::kGeneral);
  using Accumulator = GrainAccumulatorFor<kMaySlip, kMayHold>;

  /// Load of fixed grains, a part of the total.
  struct Held {
    Vec force, torque;
    bool any = false;
  };

  struct StepSum {
    Vec force, torque;
    Real damped = 0, rubbed = 0, rolled = 0, slipped = 0, yielded = 0; ///< [J]
    float deepest = 0;
    Held held;
  };
  struct MeasuredSum : StepSum {
    contact::ContactMoment moment;
  };
  using Sum = std::conditional_t<(kFeatures & contact::kMeasured) != 0, MeasuredSum, StepSum>;

  /// State of one of two grains in contact.
  struct Side {
    GrainSize<Real> size;
    Vec velocity, spin;
    bool fixed = false; ///< never moves
  };

  /// History of a contact.
  struct History {
    float* at;          ///< null if the laws need no history
    bool held;          ///< true: history of this contact; false: of an earlier one
    base::Vec3f spring; ///< first three values, or 0
    base::Vec3f angle;  ///< next three values for rolling resistance, or 0
  };

  GROUSER_HD void operator()(int k) const {
    Accumulator accumulator;
    run(k, accumulator);
  }

  /// Adds the energy changes of the step to `accumulator`, if there is a ledger.
  GROUSER_HD void run(int k, Accumulator& accumulator) const {
    if (Kernel::ended()) {
      if (k == 0)
        // Each step of a batch reads only the flags of the previous step: a skipped step raises its own flag, so that
        // all later steps are skipped too.
        base::raise(&d.flags->stale);
      return;
    }
    if (d.active && k > 0 && d.active[k] == d.active[k - 1]) return;
    const int i = d.active ? static_cast<int>(d.active[k]) : k;
    Sum sum;
    const base::Position p = d.position[i];
    const Motion m = d.motion[i];
    const Vec4f v = m.velocity, w = m.spin;
    if (d.excluded && d.excluded[i] != 0) return;
    if (has(kFixed) && isFixed(v)) return stay(i, p, m, accumulator);
    const GrainSize<Real> size = Kernel::sizeOf(v.w, w.w);
    gatherGrains(i, p, {size, v.xyz().template as<Real>(), w.xyz().template as<Real>()}, sum);
    // Loaded before the stores below: the compiler may not move a load across a store that might alias it.
    const Remainders kept = d.remainders[i];
    const base::Vec3<std::uint32_t> reference = d.reference[i];
    if (has(kFixed) && sum.held.any) accountFixedGrain(p, sum.held, accumulator);
    if (has(contact::kPlastic) && has(kLedger)) addRare(d, i, kPlasticDissipation, static_cast<double>(sum.yielded));
    if (has(kBoundaries)) addBoundaries(i, size, sum);
    base::Vec3d force = sum.force.template as<double>(), torque = sum.torque.template as<double>();
    if (has(kSurfaces)) addSurfaces(i, force);
    if (has(kLoads)) addLoads(i, size, force, torque);
    const Lost lost{static_cast<double>(sum.damped), static_cast<double>(sum.rubbed), static_cast<double>(sum.rolled),
                    static_cast<double>(sum.slipped)};
    advance(i, {p, m, kept, reference}, size, force, torque, sum.deepest, lost, accumulator);
  }

  /// State before the step.
  struct State {
    base::Position position;
    Motion motion;
    Remainders kept;
    base::Vec3<std::uint32_t> reference;
  };

  /// Finds the touching neighbours first, then computes the contacts. In a single pass the threads of a warp would wait
  /// for each other's contacts, which are rarely at the same list positions.
  GROUSER_HD void gatherGrains(int i, const base::Position& p, const Side& own, Sum& sum) const {
    const std::uint32_t n = d.neighbours.count[i];
    // 64 neighbours per word; equal spheres cannot have more.
    std::uint64_t* touching = d.neighbours.touching + (has(kManyRadii) ? i * d.neighbours.maskWords : i);
    for (std::uint32_t first = 0; first == 0 || first < n; first += 64) {
      const std::uint32_t count = has(kManyRadii) && n - first > 64 ? 64 : n - first;
      const std::int64_t row = d.neighbours.at(i, first);
      const std::uint64_t before = *touching, now = findTouching(p, row, count, sum);
      // The next slot is loaded early, to hide its latency.
      const auto slotOf = [&](std::uint64_t bits) {
        return d.neighbours.slot[row + base::lowestBit(bits) * d.neighbours.stride];
      };
      std::uint32_t j = now != 0 ? slotOf(now) : 0;
      for (std::uint64_t rest = now; rest != 0;) {
        const int k = base::lowestBit(rest);
        rest &= rest - 1;
        const std::uint32_t next = rest != 0 ? slotOf(rest) : 0;
        const std::int64_t at = row + k * d.neighbours.stride;
        touchNeighbour(historyAt(at), at, j, before >> k & 1, p, own, sum);
        j = next;
      }
      *touching++ = now;
      if (!has(kManyRadii)) break;
    }
  }

  /// Returns the bit mask of touching spheres among `count` listed neighbours.
  GROUSER_HD std::uint64_t findTouching(const base::Position& p, std::int64_t row, std::uint32_t count,
                                        Sum& sum) const {
    constexpr std::uint32_t kTogether = 4; // loads issued before the first result is used
    std::uint64_t touching = 0;
    for (std::uint32_t first = 0; first < count; first += kTogether) {
      base::Position there[kTogether];
      std::uint32_t j[kTogether], reach[kTogether] = {};
      for (std::uint32_t k = 0; k < kTogether; ++k) {
        const std::int64_t at = row + (first + k < count ? first + k : first) * d.neighbours.stride;
        j[k] = d.neighbours.slot[at];
        if (has(kManyRadii)) reach[k] = d.neighbours.reach[at];
      }
      for (std::uint32_t k = 0; k < kTogether; ++k) there[k] = d.position[j[k]];
      for (std::uint32_t k = 0; k < kTogether; ++k) {
        const std::int64_t distance2 = base::squaredNorm(Kernel::apart(p, there[k]));
        const std::int64_t reach2 = has(kManyRadii) ? squareOf(reach[k]) : d.diameterUnits2;
        if (distance2 >= reach2 || first + k >= count) continue;
        if (distance2 == 0) // undefined normal: the overlap alarm stops the run
          sum.deepest = d.diameter;
        else
          touching |= std::uint64_t{1} << (first + k);
      }
    }
    return touching;
  }

  /// Square by one 32-bit to 64-bit multiplication.
  GROUSER_HD static std::int64_t squareOf(std::uint32_t units) {
    return static_cast<std::int64_t>(std::uint64_t{units} * units);
  }

  /// History of the contact at list entry `at`; null if the laws need no history.
  GROUSER_HD float* historyAt(std::int64_t at) const {
    return Kernel::hasHistory() ? d.neighbours.history + at * Kernel::historyWidth() : nullptr;
  }

  /// Computes the contact with neighbour j at list entry `at`. `heldBefore`: in contact in the last step.
  GROUSER_HD void touchNeighbour(float* kept, std::int64_t at, std::uint32_t j, bool heldBefore,
                                 const base::Position& p, const Side& own, Sum& sum) const {
    History history{kept, Kernel::hasHistory() && heldBefore, {}, {}};
    // Loaded unconditionally, together with the neighbour's state: a branch would serialise the two memory latencies.
    // An unused value is discarded.
    if (Kernel::hasHistory()) history.spring = loadVector(history.at);
    if (has(contact::kRollingFriction)) history.angle = loadVector(history.at + 3);
    if (!history.held) history.spring = history.angle = {};
    const auto [velocity, spin] = d.motion[j];
    const base::Vec3i apart = Kernel::apart(p, d.position[j]);
    Side other{{}, velocity.xyz().template as<Real>(), spin.xyz().template as<Real>()};
    if (has(kFixed)) other.fixed = isFixed(velocity);
    std::int64_t reach2 = d.diameterUnits2;
    Real reach = f.diameterUnits;
    if (has(kManyRadii)) {
      other.size = Kernel::sizeOf(velocity.w, spin.w);
      const std::uint32_t units = d.neighbours.reach[at];
      reach2 = squareOf(units), reach = static_cast<Real>(units);
    }
    const std::int64_t distance2 = base::squaredNorm(apart);
    touchGrain(history,
               contact::spherePair(apart.as<Real>(), static_cast<Real>(distance2),
                                   static_cast<Real>(reach2 - distance2), reach, f.unit),
               own, other, sum);
  }

  GROUSER_HD void touchGrain(const History& history, const contact::SpherePair<Real>& pair, const Side& own,
                             const Side& other, Sum& sum) const {
    const Vec& normal = pair.normal;
    const Real overlap = pair.overlap;
    contact::BasicContactGeometry<Real> touch{normal, overlap, own.velocity - other.velocity, f.halfMass,
                                              Real(0.5) * f.radius};
    const bool onGround = has(kFixed) && other.fixed;
    const contact::BasicLaw<Real>& law =
        has(kManyMaterials) ? f.pairLaws[own.size.material * d.materials + other.size.material] : f.law;
    if (onGround) touch.effectiveMass = own.size.mass, touch.dampingShare = law.fixedShare;
    // Both lever arms end at the same point, at half the overlap, so that angular momentum is conserved.
    Real arm = Real(0.5) * pair.distance;
    if (has(kManyRadii)) {
      const GrainSize<Real>&a = own.size, &b = other.size;
      arm = a.radius - Real(0.5) * overlap;
      touch.velocity += cross(own.spin * arm + other.spin * (b.radius - Real(0.5) * overlap), normal);
      if (!onGround) touch.effectiveMass = a.mass * b.mass / (a.mass + b.mass);
      touch.effectiveRadius = a.radius * b.radius / (a.radius + b.radius);
    } else {
      touch.velocity += cross(own.spin + other.spin, normal * arm);
    }
    Vec shear = history.spring.template as<Real>();
    contact::BasicPlasticState<Real> plastic{};
    if (has(contact::kPlastic) && history.held) plastic = loadPlastic<Real>(Kernel::plasticIn(history.at));
    const auto reaction =
        contact::contactForce<Kernel::kLaw>(law, touch, f.timeStep, shear, has(contact::kPlastic) ? &plastic : nullptr);
    if (Kernel::hasHistory()) storeVector(history.at, shear.template as<float>());
    if (has(contact::kPlastic)) storePlastic(Kernel::plasticIn(history.at), plastic);
    // The other half belongs to the neighbour, unless it is fixed.
    const Real share = onGround ? Real(1) : Real(0.5);
    Vec torque{};
    if (has(contact::kFriction)) torque = cross(normal * arm, reaction.force);
    sum.force += reaction.force;
    if constexpr ((kFeatures & contact::kMeasured) != 0)
      sum.moment.add(reaction.force.template as<double>(), (normal * arm).template as<double>());
    if (has(contact::kFriction)) sum.torque += torque;
    sum.damped += share * reaction.damped;
    if (has(contact::kFriction)) sum.rubbed += share * reaction.rubbed;
    if (has(contact::kFriction) && has(contact::kHertz)) sum.slipped += share * reaction.slipped;
    if (has(contact::kPlastic)) sum.yielded += share * reaction.yielded;
    if (has(contact::kRollingFriction)) {
      Vec angle = history.angle.template as<Real>();
      const GrainSize<Real>&a = own.size, &b = other.size;
      const Real inertia = onGround          ? contact::rollingInertia(a.mass, a.radius)
                           : has(kManyRadii) ? contact::rollingInertia(a.mass, a.radius, b.mass, b.radius)
                                             : contact::rollingInertia(f.mass, f.radius, f.mass, f.radius);
      const contact::RollingMotion<Real> motion{normal, own.spin - other.spin, touch.effectiveRadius, inertia};
      Real rolled = 0;
      const Vec rolling = contact::rollingTorque(law, motion, reaction.pressing, reaction.normalStiffness, f.timeStep,
                                                 angle, rolled, has(contact::kHertz) ? &reaction.change : nullptr);
      sum.torque += rolling, torque += rolling;
      sum.rolled += share * rolled;
      storeVector(history.at + 3, angle.template as<float>());
    }
    if (static_cast<float>(overlap) > sum.deepest) sum.deepest = static_cast<float>(overlap);
    if (onGround) sum.held.any = true, sum.held.force += reaction.force, sum.held.torque += torque;
  }

  /// Copies the state of a fixed grain, and accounts for the ground reaction to loads of parts.
  GROUSER_HD void stay(int i, const base::Position& p, const Motion& m, Accumulator& accumulator) const {
    d.nextPosition[i] = p, d.nextMotion[i] = m;
    if (!has(kLoads) || d.loads.range[i] == 0) return;
    base::Vec3d force, torque;
    addLoads(i, Kernel::sizeOf(m.velocity.w, m.spin.w), force, torque);
    accountFixedGrain(p, {(-force).template as<Real>(), (-torque).template as<Real>()}, accumulator);
  }

  /// Adds impulses of fixed grains to those of walls. Few grains touch a fixed grain.
  GROUSER_HD void accountFixedGrain(const base::Position& p, const Held& held, Accumulator& accumulator) const {
    if (!has(kLedger)) return;
    const base::Vec3d x = base::toUnits(p).as<double>() * d.unitLength;
    const base::Vec3d force = held.force.template as<double>();
    if constexpr (kMayHold)
      accumulator.addForce(force, cross(x, force) + held.torque.template as<double>(), d.ledgerScale);
  }

  GROUSER_HD void addBoundaries(int i, const GrainSize<Real>& size, Sum& sum) const {
    const std::uint32_t place = d.boundaryOf[i];
    if (place == 0) return;
    const BoundaryLoad<Real>& load = f.boundaryLoads[place - 1];
    sum.force += load.force;
    sum.torque += load.torque;
    if (static_cast<float>(load.deepest) > d.maxSurfaceShare * static_cast<float>(size.radius))
      raise(Fault::through, i);
  }

  /// Adds the forces of moving surfaces, which receive exactly the opposite.
  GROUSER_HD void addSurfaces(int i, base::Vec3d& force) const {
    if (const std::uint32_t place = d.boundaryOf[i]) force += d.fromSurfaces[place - 1];
  }

  /// Adds the forces of rigid parts as integers, since the parts receive exactly the opposite.
  GROUSER_HD void addLoads(int i, const GrainSize<Real>& size, base::Vec3d& force, base::Vec3d& torque) const {
    const std::uint32_t range = d.loads.range[i];
    if (range == 0) return;
    base::Vec3l quanta{};
    const std::uint32_t first = range >> 8, count = range & 255u;
    for (std::uint32_t k = 0; k < count; ++k) {
      const contact::GrainLoad& load = d.loads.load[first + k];
      quanta += load.force;
      torque += load.torque.template as<double>();
      // Stones can be jammed between tooth and track: a part may overlap a grain more than another grain may, but not
      // beyond the grain's centre.
      if (load.deepest > static_cast<float>(size.radius)) raise(Fault::through, i);
    }
    force += d.loads.force.value(quanta);
    for (int a = 0; a < 3; ++a) base::atomicAdd64(d.loads.received + a, quanta[a]);
  }

  /// Accounts for a grain's step. `work`: on the grain; `massShare`: mass / model mass.
  GROUSER_HD void account(const base::Position& place, double work, double massShare, const Lost& lost,
                          Accumulator& accumulator) const {
    const double q = d.ledgerScale.perEnergy;
    accumulator.of[kWork] += wholeQuanta(q * work);
    accumulator.of[kTurnover] += wholeQuanta(q * fabs(work));
    accumulator.of[kDashpotDissipation] += wholeQuanta(q * lost.damped);
    if (Kernel::hasHistory()) accumulator.of[kSlidingDissipation] += wholeQuanta(q * lost.rubbed);
    if constexpr (kMaySlip)
      if (has(contact::kHertz) && has(contact::kFriction))
        accumulator.of[kMicroSlipDissipation] += wholeQuanta(q * lost.slipped);
    if (has(contact::kRollingFriction)) accumulator.of[kRollingDissipation] += wholeQuanta(q * lost.rolled);
    accumulator.of[kMass] += has(kManyRadii) ? wholeQuanta(massShare * kMassQuanta) : kMassQuanta;
    const base::Vec3l u = base::toUnits(place);
    for (int a = 0; a < 3; ++a)
      accumulator.of[kMoment + a] += has(kManyRadii) ? wholeQuanta(massShare * static_cast<double>(u[a])) : u[a];
  }

  /// Wraps a grain that has left through a periodic boundary to the opposite side. Its reference position (at the last
  /// list) is shifted by the same period, so that its displacement since then, and the neighbour list, remain valid.
  GROUSER_HD void crossSides(int i, base::Vec3l& place, base::Vec3<std::uint32_t>& reference) const {
    for (int a = 0; a < 2; ++a) {
      const int periods = d.period.periodsBack(a, place[a]);
      if (periods == 0) continue;
      const std::int64_t shift = periods * d.period.length[a];
      place[a] += shift;
      reference[a] += static_cast<std::uint32_t>(shift);
      d.reference[i][a] = reference[a];
      (a == 0 ? d.crossings[i].x : d.crossings[i].y) -= periods;
    }
  }

  /// Advances v += a dt, x += v dt, w += alpha dt, each with its remainder.
  GROUSER_HD void advance(int i, const State& now, const GrainSize<Real>& size, const base::Vec3d& force,
                          const base::Vec3d& torque, float deepest, const Lost& lost, Accumulator& accumulator) const {
    base::Vec3f v = now.motion.velocity.xyz(), w = now.motion.spin.xyz();
    double stepPerMass = d.stepPerMass, stepPerInertia = d.stepPerInertia;
    base::Vec3d gained, turned; // changes of half squared velocities
    double massShare = 1, inertia = d.inertia;
    float maxOverlap = d.maxOverlap;
    if (has(kManyRadii)) {
      const double mass = static_cast<double>(size.mass), radius = static_cast<double>(size.radius);
      inertia = 0.4 * mass * radius * radius, massShare = mass / d.mass;
      stepPerMass = d.timeStep / mass;
      stepPerInertia = d.timeStep / inertia;
      maxOverlap = d.maxOverlapShare * static_cast<float>(size.radius);
    }
    Remainders kept = now.kept;
    base::Vec3<std::uint32_t> r = now.reference;
    base::Vec3l moved = base::toUnits(now.position);
    for (int a = 0; a < 3; ++a) {
      std::int16_t rv = lowRemainder(kept.axis[a]), rw = highRemainder(kept.axis[a]);
      const double faster = force[a] * stepPerMass + d.gravityStep[a], turning = torque[a] * stepPerInertia;
      const CompensatedStep speed = addCompensated(v[a], rv, faster);
      if (has(kLedger)) gained[a] = halfSquareGained(faster, speed);
      if (Kernel::hasHistory() || has(kLoads)) {
        const CompensatedStep turn = addCompensated(w[a], rw, turning);
        if (has(kLedger)) turned[a] = halfSquareGained(turning, turn);
      }
      kept.axis[a] = packRemainders(rv, rw);
      const double displacement = speed.sum * d.unitsPerSpeed;
      // A NaN speed must not reach the integer conversion.
      if (displacement > -kMaxUnitsPerStep && displacement < kMaxUnitsPerStep)
        moved[a] += advanceKeeping(displacement, kept.position, a);
    }
    if (has(kLedger)) {
      const base::Vec3d work = gained * (d.mass * massShare) + turned * inertia;
      account(now.position, (work.x + work.z) + work.y, massShare, lost, accumulator); // sum order as in SIMD
    }
    if (has(kPeriodic)) crossSides(i, moved, r);
    const base::Position q = base::fromUnits(moved);
    d.nextPosition[i] = q;
    d.nextMotion[i] = {{v.x, v.y, v.z, has(kManyRadii) ? now.motion.velocity.w : 0.0f},
                       {w.x, w.y, w.z, has(kManyMaterials) ? now.motion.spin.w : 0.0f}};
    d.remainders[i] = kept;

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
    else if (deepest > maxOverlap)
      fault = Fault::overlap;
    else if (speed2 > d.maxSpeed2)
      fault = Fault::speed;
    if (fault != Fault::none) raise(fault, i);
  }
};

} // namespace grouser::terrain
