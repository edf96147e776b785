// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/bits.hpp"
#include "terrain/feet_search.hpp"
#include "terrain/impulse_rows.cuh"

/// Kernels that create the rows of a step: geometry, constants and initial impulses of contacts that may close in it.
namespace grouser::terrain {

template <class Real> struct ImpulseKernel : GrainKernel<contact::kGeneral, Real> {
  using Kernel = GrainKernel<contact::kGeneral, Real>;
  using Kernel::d, Kernel::f, Kernel::has;
  using Vec = base::Vec3<Real>;
  using Touch = contact::ImpulseTouch<Real>;
  using Law = contact::BasicLaw<Real>;
  ImpulseData<Real> s;

  struct Arms {
    Real own, other; ///< [m]
  };

  /// Maximum gap [units] of a row whose sides have the total speed `speed` [m/s].
  GROUSER_HD std::int64_t marginFor(double speed) const {
    const double way = speed * d.unitsPerSpeed, most = static_cast<double>(s.margin - s.minMargin);
    return s.minMargin + static_cast<std::int64_t>(way < most ? way : most);
  }
  GROUSER_HD double speedOf(int i) const { return norm(d.motion[i].velocity.xyz().template as<double>()); }

  GROUSER_HD bool fixedAt(std::uint32_t j) const { return has(kFixed) && isFixed(d.motion[j].velocity); }
  GROUSER_HD static Real inertiaOf(const GrainSize<Real>& size) {
    return Real(0.4) * size.mass * size.radius * size.radius;
  }

  /// Loads the springs of the last step, rotates them into the current tangent plane and adapts them to the stiffness;
  /// zero in a new contact. Stores them back to `history` for the end of the step.
  GROUSER_HD void takeSprings(float* history, const base::Mat3d* turned, bool rolls, const Law& law,
                              Touch& touch) const {
    if (touch.held) {
      touch.shear = turnedSpring<Real>(history, turned);
      if (!s.rules.rigid) touch.shear = contact::detail::tangentOf(touch.shear, touch.push);
      if (rolls) touch.angle = contact::detail::tangentOf(turnedSpring<Real>(history + 3, turned), touch.push);
      if (!s.rules.rigid) contact::followStiffness(law, touch, s.rules.timeStep);
    }
    storeTurned(history, turned, touch.shear);
    if (rolls) storeTurned(history + 3, turned, touch.angle);
  }

  /// Contact of a grain with a boundary or part, without history. The other contact point has the velocity `moves`
  /// [m/s] and spin `turns` [rad/s], and gains `gains` [m/s] in this step without contacts.
  GROUSER_HD Touch touchOf(int i, const GrainSize<Real>& size, const Vec& push, Real gap, const Arms& arms,
                           const Vec& moves, const Vec& turns, const Vec& gains) const {
    const ImpulseMotion<Real> mine = motionAtStart<Real>(d, i);
    Touch touch{};
    touch.push = push, touch.gap = gap;
    touch.velocity = relativeVelocity(mine, {}, push, arms.own, arms.other) - moves;
    touch.spin = mine.spin - turns;
    touch.freely = dot(d.gravityStep.template as<Real>() - gains, push);
    touch.effectiveMass = touch.movedMass = size.mass, touch.effectiveRadius = size.radius;
    touch.rollingInertia = contact::rollingInertia(size.mass, size.radius);
    touch.dampingShare = 1;
    return touch;
  }
  /// Upper bound of a body's velocity change per impulse at a contact point [1/kg], from the trace of the rotational
  /// part.
  GROUSER_HD Real mobilityOf(const contact::BodyResponse::Inverse& body, const Vec& arm) const {
    const base::Vec3d r = arm.template as<double>();
    const base::Vec3d lever[] = {{0, r.z, -r.y}, {-r.z, 0, r.x}, {r.y, -r.x, 0}}; // r x e of the three axes
    double turning = 0;
    for (const base::Vec3d& axis : lever) turning += dot(axis, body.inertia * axis);
    return static_cast<Real>(body.mass + (s.rolls ? 2 : 1) * turning);
  }
  GROUSER_HD static Arms armsOf(const GrainSize<Real>& size, Real gap) {
    return {size.radius + (gap < 0 ? gap : Real(0)), Real(0)};
  }

  /// Stores a row and its initial impulse.
  GROUSER_HD void put(const ImpulseRowsView<Real>& rows, std::int64_t at, const contact::ImpulseRow<Real>& row,
                      const Arms& arms, Real overlap, std::uint32_t other, std::uint32_t place,
                      bool counts = true) const {
    rows.row[at] = {row.push, arms.own, row.softness, row.shearSoftness, row.cone.friction, Real(counts ? 1 : -1)};
    rows.other[at] = {row.offset, arms.other, Real(0), Real(0), other, place | (row.impact ? kImpactBit : 0u)};
    rows.end[at] = {overlap,     row.pull,   row.damping,      row.shearDamping, row.rollingDamping,
                    row.slipped, row.rolled, row.normalOffset, row.hertz};
    const contact::Impulse<Real> start = contact::cutToCoulomb(row.start, row.push, row.cone);
    rows.impulse[s.now][at] = start.linear;
    if (!rows.rolling) return;
    rows.rolling[at] = {row.turnOffset, row.rollingSoftness, row.cone.arm, Real(0)};
    rows.turning[s.now][at] = start.rolling;
  }
};

/// Creates the rows of a grain with other grains, and its motion without contacts.
template <class Real> struct MakeGrainRows : ImpulseKernel<Real> {
  static constexpr double kNanoseconds = 300;
  using Base = ImpulseKernel<Real>;
  using Base::d, Base::f, Base::has, Base::s;
  using typename Base::Arms, typename Base::Kernel, typename Base::Law, typename Base::Touch, typename Base::Vec;

  GROUSER_HD void operator()(int i) const {
    s.grainRows[i] = 0;
    if (hasNoRows(d, s, i)) return;
    const GrainSize<Real> size = Kernel::sizeOf(i);
    const base::Position p = d.position[i];
    const double ownSpeed = Base::speedOf(i) + 2 * norm(d.gravityStep);
    Vec pulled{};
    std::uint32_t rows = 0;
    for (std::uint32_t k = 0; k < d.neighbours.count[i]; ++k) {
      const std::int64_t at = d.neighbours.at(i, k);
      const std::uint32_t j = d.neighbours.slot[at];
      const base::Vec3i apart = Kernel::apart(p, d.position[j]);
      const std::int64_t distance2 = base::squaredNorm(apart);
      const std::int64_t reach = has(kManyRadii) ? std::int64_t{d.neighbours.reach[at]} : d.diameterUnits;
      const std::int64_t range = reach + Base::marginFor(ownSpeed + Base::speedOf(static_cast<int>(j)));
      if (distance2 == 0) Base::raise(Fault::overlap, i); // contact normal undefined
      if (distance2 >= range * range || distance2 == 0) continue;
      const bool held = d.neighbours.touching[i * d.neighbours.maskWords + k / 64] >> (k & 63u) & 1;
      add(i, size, j, k, apart, distance2, reach, at, held, d.neighbours.at(i, rows++), pulled);
    }
    s.grainRows[i] = rows;
    s.free[i] = freely(i, size, pulled);
  }

private:
  GROUSER_HD void add(int i, const GrainSize<Real>& size, std::uint32_t j, std::uint32_t k, const base::Vec3i& apart,
                      std::int64_t distance2, std::int64_t reach, std::int64_t listed, bool held, std::int64_t at,
                      Vec& pulled) const {
    const auto pair =
        contact::spherePair(apart.as<Real>(), static_cast<Real>(distance2),
                            static_cast<Real>(reach * reach - distance2), static_cast<Real>(reach), f.unit);
    const GrainSize<Real> other = Kernel::sizeOf(static_cast<int>(j));
    const bool ground = Base::fixedAt(j);
    const Law& law = has(kManyMaterials) ? f.pairLaws[size.material * d.materials + other.material] : f.law;
    // Both arms end at the same point, which conserves angular momentum: the radii determine each sphere's share.
    const Real share = pair.distance / (size.radius + other.radius);
    const Arms arms{size.radius * share, other.radius * share};
    const ImpulseMotion<Real> mine = motionAtStart<Real>(d, i), theirs = motionAtStart<Real>(d, static_cast<int>(j));
    Touch touch{};
    touch.push = -pair.normal, touch.gap = -pair.overlap;
    touch.velocity = relativeVelocity(mine, theirs, touch.push, arms.own, arms.other);
    touch.spin = mine.spin - theirs.spin;
    touch.freely = ground ? dot(d.gravityStep.template as<Real>(), touch.push) : Real(0);
    touch.effectiveMass = ground ? size.mass : size.mass * other.mass / (size.mass + other.mass);
    touch.movedMass = touch.effectiveMass;
    touch.effectiveRadius = size.radius * other.radius / (size.radius + other.radius);
    touch.rollingInertia = ground ? contact::rollingInertia(size.mass, size.radius)
                                  : contact::rollingInertia(size.mass, size.radius, other.mass, other.radius);
    touch.dampingShare = ground ? law.fixedShare : Real(1);
    touch.held = held;
    if (Kernel::hasHistory())
      Base::takeSprings(d.neighbours.history + listed * Kernel::historyWidth(), nullptr, has(contact::kRollingFriction),
                        law, touch);
    const contact::ImpulseRow<Real> row = contact::impulseRow(law, touch, s.rules);
    pulled -= row.push * row.pull;
    Base::put(s.grains, at, row, arms, pair.overlap, ground ? kFixedPartner : j, k, ground || d.id[i] < d.id[j]);
  }

  /// Velocities at the end of the step without contacts: due to gravity and cohesion only.
  GROUSER_HD ImpulseMotion<Real> freely(int i, const GrainSize<Real>& size, const Vec& pulled) const {
    const Remainders kept = d.remainders[i];
    const base::Vec3f v = d.motion[i].velocity.xyz(), w = d.motion[i].spin.xyz();
    base::Vec3d velocity, spin;
    for (int a = 0; a < 3; ++a) {
      velocity[a] = withRemainder(v[a], lowRemainder(kept.axis[a])) + d.gravityStep[a] +
                    static_cast<double>(pulled[a]) / static_cast<double>(size.mass);
      spin[a] = withRemainder(w[a], highRemainder(kept.axis[a]));
    }
    return {velocity.template as<Real>(), spin.template as<Real>()};
  }
};

/// Creates the rows of a grain with walls, floor and surfaces.
template <class Real> struct MakeBoundaryRows : ImpulseKernel<Real> {
  static constexpr double kNanoseconds = 200;
  using Base = ImpulseKernel<Real>;
  using Base::d, Base::f, Base::has, Base::s;
  using typename Base::Arms, typename Base::Kernel, typename Base::Law, typename Base::Touch, typename Base::Vec;

  /// Grain near boundaries, with its rows so far.
  struct Grain {
    int place, slot;
    base::Vec3d x;
    GrainSize<Real> size;
    std::uint32_t before; ///< boundaries in contact in the last step
    std::uint32_t rows = 0;
    Vec pulled{};
  };

  GROUSER_HD void operator()(int k) const {
    s.boundRows[k] = 0;
    const int i = static_cast<int>(d.nearBoundary[k]);
    if (hasNoRows(d, s, i)) return checkFixed(i);
    Grain grain{k, i, base::toUnits(d.position[i]).template as<double>() * d.unitLength, Kernel::sizeOf(i),
                d.boundaryContactMask[i]};
    const double radius = static_cast<double>(grain.size.radius);
    const double speed = Base::speedOf(i) + norm(d.gravityStep);
    const double margin = static_cast<double>(Base::marginFor(speed)) * d.unitLength;
    for (int b = 0; b < d.wallCount; ++b) {
      const double gap = dot(d.walls[b].normal, grain.x) - d.walls[b].offset - radius;
      if (gap < margin) add(grain, b, d.walls[b].normal, gap, nullptr);
    }
    if (has(kFloor) && d.floor.marks)
      addHollows(grain, radius);
    else if (has(kFloor) && !d.floor.clearOf(grain.x, radius + margin)) {
      const FootPoint foot = d.floor.closestPoint(grain.x);
      if (foot.distance - radius < margin) add(grain, d.wallCount, foot.normal, foot.distance - radius, nullptr);
    }
    const int first = d.boundaryCount - d.surfaceCount;
    for (int b = 0; has(kSurfaces) && b < d.surfaceCount; ++b) {
      const contact::PartMotion& motion = d.placements[b].motion;
      const SurfaceGap gap = gapTo(d.surfaces[b], motion.toPart(grain.x));
      const double together = speed + norm(motion.velocityAt(grain.x));
      if (gap.distance - radius < static_cast<double>(Base::marginFor(together)) * d.unitLength)
        add(grain, first + b, motion.rotation * gap.normal, gap.distance - radius, &d.placements[b]);
    }
    s.boundRows[k] = grain.rows;
    s.free[i].velocity += grain.pulled * (Real(1) / grain.size.mass);
  }

private:
  /// Fixed grains have no rows: contact between a surface and a fixed grain is a fault.
  GROUSER_HD void checkFixed(int i) const {
    const base::Vec3d x = base::toUnits(d.position[i]).template as<double>() * d.unitLength;
    for (int b = 0; b < d.surfaceCount; ++b)
      if (gapTo(d.surfaces[b], d.placements[b].motion.toPart(x)).distance <
          static_cast<double>(Kernel::sizeOf(i).radius))
        Base::raise(Fault::through, i);
  }

  /// Adds the contacts with a floor that has hollows tighter than the grain.
  GROUSER_HD void addHollows(Grain& grain, double radius) const {
    if (d.floor.clearOf(grain.x, radius)) return;
    float* normals = Kernel::hasHistory() ? d.floorNormals(grain.place, Kernel::historyWidth()) : nullptr;
    const PlacedFeet placed(d.floor, grain.x, radius, grain.before >> d.wallCount, normals);
    const Feet& feet = placed.feet;
    const FeetLoads loads(feet, radius, Kernel::boundaryLaw(d.wallCount, grain.size.material).hertz);
    grain.before = (grain.before & ~(kFloorBits << d.wallCount)) | placed.goOn << d.wallCount;
    for (int k = 0; k < feet.count; ++k) {
      if (!(loads.overlap(k) > 0)) continue;
      if (radius - feet.foot[k].distance > static_cast<double>(d.maxSurfaceShare) * radius)
        Base::raise(Fault::through, grain.slot);
      add(grain, d.wallCount + placed.place[k], feet.foot[k].normal, -loads.overlap(k), nullptr,
          static_cast<Real>(loads.share(k)));
      if (normals) storeVector(normals + 3 * placed.place[k], feet.foot[k].normal.template as<float>());
    }
  }

  /// Adds a row. `pose`: null for a boundary at rest; `share`: factor of dashpots and cohesion [-].
  GROUSER_HD void add(Grain& grain, int boundary, const base::Vec3d& outward, double gap, const SurfacePose* pose,
                      Real share = 1) const {
    const Vec push = outward.template as<Real>();
    const Arms arms = Base::armsOf(grain.size, static_cast<Real>(gap));
    Vec moves{}, turns{}, gains{};
    if (pose) {
      const base::Vec3d point = grain.x - outward * static_cast<double>(arms.own);
      moves = pose->motion.velocityAt(point).template as<Real>(), turns = pose->motion.spin.template as<Real>();
    }
    if (pose && pose->inverseMass > 0) {
      gains = (pose->axis * pose->gains).template as<Real>();
      base::atomicAdd32(s.surfaceRows + (boundary - (d.boundaryCount - d.surfaceCount)), 1);
    }
    const Law& law = Kernel::boundaryLaw(boundary, grain.size.material);
    Touch touch = Base::touchOf(grain.slot, grain.size, push, static_cast<Real>(gap), arms, moves, turns, gains);
    if (pose && pose->inverseMass > 0)
      touch.movedMass = Real(1) / (Real(1) / grain.size.mass + static_cast<Real>(pose->inverseMass));
    touch.dampingShare = share, touch.pullShare = share;
    touch.held = grain.before >> boundary & 1;
    if (Kernel::hasHistory())
      Base::takeSprings(d.historyOf(grain.place, boundary, Kernel::historyWidth()), pose ? &pose->turned : nullptr,
                        has(contact::kRollingFriction), law, touch);
    contact::ImpulseRow<Real> row = contact::impulseRow(law, touch, s.rules);
    grain.pulled -= row.push * row.pull;
    row.offset -= moves + gains, row.turnOffset -= contact::detail::tangentOf(turns, row.push);
    Base::put(s.bounds, std::int64_t{grain.place} + grain.rows++ * s.near, row, arms, -touch.gap, kFixedPartner,
              static_cast<std::uint32_t>(boundary));
  }
};

/// Counts the rows of each grain, and adds the cohesion with parts to its free motion.
template <class Real> struct CountRows : ImpulseKernel<Real> {
  using Base = ImpulseKernel<Real>;
  using Base::d, Base::s;
  using typename Base::Kernel, typename Base::Vec;
  GROUSER_HD void operator()(int i) const {
    if (s.ghost && s.ghost[i] != 0) return; // set by the halo exchange
    std::uint32_t rows = s.grainRows[i];
    if (const std::uint32_t at = d.boundaryCount > 0 ? d.boundaryOf[i] : 0) rows += s.boundRows[at - 1];
    Vec pulled{};
    forPartRowsOf(s, i, [&](int, std::int64_t at) {
      pulled -= s.parts.row[at].push * s.parts.end[at].pull;
      ++rows;
    });
    s.degree[i] = rows;
    if (s.patches.pairs > 0) s.free[i].velocity += pulled * (Real(1) / Kernel::sizeOf(i).mass);
  }
};

/// Weight of shear relative to the normal direction in the metric [-]: 1 + m R^2 / I of a solid sphere; 1 + 2 m R^2 / I
/// if rolling rows also rotate the grain.
template <class Real> GROUSER_HD constexpr Real shearWeight(bool rolls) { return rolls ? Real(6) : Real(3.5); }

/// Computes the metric of each row. It bounds the effect of all rows of both grains on the row's velocity: each grain's
/// mass is split among its rows (Tonge, Benevolenski and Voroshilov 2012, ACM Trans. Graph. 31:105). With this step
/// size the objective of the convex problem never increases.
template <class Real> struct WeighRows : ImpulseKernel<Real> {
  static constexpr double kNanoseconds = 60;
  using Base = ImpulseKernel<Real>;
  using Base::d, Base::s;
  using typename Base::Kernel, typename Base::Vec;

  GROUSER_HD void operator()(int i) const {
    if (hasNoRows(d, s, i)) return;
    const GrainSize<Real> size = Kernel::sizeOf(i);
    const float own = speedOf(i, size);
    float most = 0;
    forRowsOf(d, s, i, [&](const ImpulseRowsView<Real>& rows, std::int64_t at) {
      weigh(rows, at, size, s.degree[i]);
      const float rounds = roundingOf(rows, at, own);
      most = rounds > most ? rounds : most;
    });
    base::atomicMax32(s.rounding, base::bitsAs<std::uint32_t>(most));
  }

private:
  /// Bound of the speeds of a grain's contact points at the start of the step [m/s].
  GROUSER_HD float speedOf(int i, const GrainSize<Real>& size) const {
    const ImpulseMotion<Real> motion = motionAtStart<Real>(d, i);
    return static_cast<float>(norm(motion.velocity) + norm(motion.spin) * size.radius);
  }

  /// Rounding error of a row's relative velocity [m/s]: a few places of the velocities that are subtracted, and half a
  /// quantum of each impulse on a body.
  GROUSER_HD float roundingOf(const ImpulseRowsView<Real>& rows, std::int64_t at, float own) const {
    constexpr float kPlaces = 4, kEpsilon = std::is_same_v<Real, float> ? 1.1920929e-7f : 2.2204460e-16f;
    const ImpulseRowOther<Real>& side = rows.other[at];
    float speeds = own;
    if (side.slot != kFixedPartner)
      speeds += speedOf(static_cast<int>(side.slot), Kernel::sizeOf(static_cast<int>(side.slot)));
    if (!rows.part) return kPlaces * kEpsilon * speeds;
    const PartRowRecord<Real>& on = rows.part[at];
    const BodyMotion<Real> body = s.bodyMotion[s.now][on.body];
    speeds += static_cast<float>(norm(body.at(on.arm)));
    const double arm = static_cast<double>(norm(on.arm)),
                 quantum = s.bodyPush.quantum + (arm > 0 ? s.bodyTurn.quantum / arm : 0.0);
    return kPlaces * kEpsilon * speeds +
           static_cast<float>(0.5 * quantum * s.bodyRows[on.body] *
                              static_cast<double>(Base::mobilityOf(s.body[on.body], on.arm)));
  }

  GROUSER_HD void weigh(const ImpulseRowsView<Real>& rows, std::int64_t at, const GrainSize<Real>& own,
                        std::uint32_t degree) const {
    ImpulseRowRecord<Real>& row = rows.row[at];
    ImpulseRowOther<Real>& side = rows.other[at];
    const bool alone = side.slot == kFixedPartner;
    const GrainSize<Real> other = alone ? own : Kernel::sizeOf(static_cast<int>(side.slot));
    const Real many = static_cast<Real>(degree), more = alone ? Real(0) : static_cast<Real>(s.degree[side.slot]);
    // Across a gap the arms are longer than the radii.
    const Real a = row.armOwn / own.radius, b = side.arm / other.radius, longer = a > b ? a : b;
    const Real arm2 = longer > 1 ? longer * longer : Real(1);
    int surface = 0;
    const SurfacePose* const pose = freeSurface(d, s, rows, at, surface);
    const Real given = pose ? static_cast<Real>(pose->inverseMass) : Real(0);
    Real masses = many / own.mass + more / other.mass + (pose ? s.surfaceRows[surface] * given : Real(0));
    Real yields = alone ? given : Real(1) / other.mass, turns = 0;
    if (rows.part) {
      const PartRowRecord<Real>& on = rows.part[at];
      const Real rowsOfBody = static_cast<Real>(s.bodyRows[on.body]);
      yields = Base::mobilityOf(s.body[on.body], on.arm);
      masses += rowsOfBody * yields;
      const base::Mat3d& turn = s.body[on.body].inertia;
      turns = rowsOfBody * static_cast<Real>(turn.m[0][0] + turn.m[1][1] + turn.m[2][2]);
    }
    const Real shear = (shearWeight<Real>(s.rolls) * masses * arm2 + row.shearSoftness) / shearWeight<Real>(s.rolls);
    const Real normal = masses + row.softness;
    row.signedWeight = (row.counts() ? Real(1) : Real(-1)) * (normal > shear ? normal : shear);
    side.mobility = Real(1) / own.mass + yields + row.softness, side.inertia = Real(1) / side.mobility;
    if (!rows.rolling) return;
    RollingRowRecord<Real>& roll = rows.rolling[at];
    // Rolling and shear both rotate the grain, so each counts twice.
    roll.weight = Real(2) * (many / Base::inertiaOf(own) + more / Base::inertiaOf(other) + turns) + roll.softness;
  }
};

} // namespace grouser::terrain
