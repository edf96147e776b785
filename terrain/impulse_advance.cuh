// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_step.cuh"
#include "terrain/impulse_iteration.cuh"

/// End of a step with complementarity contacts: advances the grains by their impulses and stores the springs.
namespace grouser::terrain {

template <class Real> struct AdvanceByImpulses : GrainStep<contact::kGeneral, Real> {
  static constexpr double kNanoseconds = 400;
  using Step = GrainStep<contact::kGeneral, Real>;
  using Kernel = typename Step::Kernel;
  using Vec = typename Step::Vec;
  using Accumulator = typename Step::Accumulator;
  using Step::d, Step::f, Step::has;
  ImpulseData<Real> s;

  /// Sums over the rows of a grain.
  struct Total {
    base::Vec3d force, torque;         ///< [N], [N m]
    base::Vec3d heldForce, heldTorque; ///< exerted by walls, floor and fixed grains, about the grain's centre
    Lost lost{};
    double stabilised = 0; ///< [J]
    float deepest = 0;
    std::uint32_t touching = 0; ///< bit mask of boundaries in contact
  };

  GROUSER_HD void operator()(int i) const {
    Accumulator accumulator;
    run(i, accumulator);
  }

  GROUSER_HD void run(int i, Accumulator& accumulator) const {
    if (s.ghost && s.ghost[i] != 0) return;
    const base::Position p = d.position[i];
    const Motion m = d.motion[i];
    if (has(kFixed) && isFixed(m.velocity)) {
      d.nextPosition[i] = p, d.nextMotion[i] = m;
      return;
    }
    const GrainSize<Real> size = Kernel::sizeOf(m.velocity.w, m.spin.w);
    Total total;
    endGrainRows(i, total);
    endBoundaryRows(i, p, size, total);
    endPartRows(i, p, size, total);
    if (has(kLedger) && (total.heldForce.x != 0 || total.heldForce.y != 0 || total.heldForce.z != 0)) {
      const base::Vec3d x = base::toUnits(p).as<double>() * d.unitLength;
      accumulator.addForce(total.heldForce, cross(x, total.heldForce) + total.heldTorque, d.ledgerScale);
    }
    if (has(kLedger) && total.stabilised != 0) addRare(d, i, kStabilisation, total.stabilised);
    Step::advance(i, {p, m, d.remainders[i], d.reference[i]}, size, total.force, total.torque, total.deepest,
                  total.lost, accumulator);
  }

private:
  /// Relative motion of the two sides of a contact.
  struct Relative {
    Vec velocity, spin;
  };

  GROUSER_HD const ImpulseMotion<Real>& motionAfter(std::int64_t i) const { return s.motion[s.now][i]; }

  GROUSER_HD static Relative between(const ImpulseMotion<Real>& own, const ImpulseMotion<Real>& other,
                                     const ImpulseRowRecord<Real>& row, Real armOther = 0) {
    return {relativeVelocity(own, other, row.push, row.armOwn, armOther), own.spin - other.spin};
  }

  GROUSER_HD void endGrainRows(int i, Total& total) const {
    std::uint64_t* const touching = d.neighbours.touching + i * d.neighbours.maskWords;
    for (std::int64_t w = 0; w < d.neighbours.maskWords; ++w) touching[w] = 0;
    for (std::uint32_t k = 0; k < s.grainRows[i]; ++k) {
      const std::int64_t at = d.neighbours.at(i, k);
      const ImpulseRowRecord<Real> row = s.grains.row[at];
      const ImpulseRowOther<Real> side = s.grains.other[at];
      const std::uint32_t listed = side.place & kPlaceBits;
      const std::int64_t home = d.neighbours.at(i, listed);
      const bool ground = side.slot == kFixedPartner;
      ImpulseMotion<Real> otherBefore{}, otherAfter{};
      if (!ground)
        otherBefore = motionAtStart<Real>(d, static_cast<int>(side.slot)), otherAfter = motionAfter(side.slot);
      const Relative start = between(motionAtStart<Real>(d, i), otherBefore, row, side.arm),
                     end = between(motionAfter(i), otherAfter, row, side.arm);
      float* const history = Step::historyAt(home);
      if (endRow(s.grains, at, row, start, end, history, nullptr, ground ? 1 : 0.5, total))
        touching[listed / 64] |= std::uint64_t{1} << (listed & 63u);
      add(row, forceOf(s.grains.impulse[s.now][at] - row.push * s.grains.end[at].pull), s.grains, at, ground, total);
      const auto overlap = static_cast<float>(s.grains.end[at].overlap);
      if (overlap > total.deepest) total.deepest = overlap;
    }
  }

  GROUSER_HD void endBoundaryRows(int i, const base::Position& p, const GrainSize<Real>& size, Total& total) const {
    const std::uint32_t place = d.boundaryCount > 0 ? d.boundaryOf[i] : 0;
    if (place == 0) return;
    const base::Vec3d x = base::toUnits(p).as<double>() * d.unitLength;
    const int first = d.boundaryCount - d.surfaceCount;
    for (std::uint32_t k = 0; k < s.boundRows[place - 1]; ++k) {
      const std::int64_t at = std::int64_t{place} - 1 + k * s.near;
      const ImpulseRowRecord<Real> row = s.bounds.row[at];
      const int boundary = static_cast<int>(s.bounds.other[at].place & kPlaceBits);
      const SurfacePose* const pose = boundary >= first ? d.placements + (boundary - first) : nullptr;
      const base::Vec3d point = x - row.push.template as<double>() * static_cast<double>(row.armOwn);
      Relative start = between(motionAtStart<Real>(d, i), {}, row), end = between(motionAfter(i), {}, row);
      if (pose) {
        const Vec moves = pose->motion.velocityAt(point).template as<Real>(),
                  turns = pose->motion.spin.template as<Real>();
        start.velocity -= moves, end.velocity -= moves, start.spin -= turns, end.spin -= turns;
        if (pose->inverseMass > 0)
          end.velocity -= pose->axis.template as<Real>() *
                          (static_cast<Real>(pose->gains) + s.surfaceChange[s.now][boundary - first]);
      }
      float* const history =
          Kernel::hasHistory() ? d.historyOf(std::int64_t{place} - 1, boundary, Kernel::historyWidth()) : nullptr;
      if (endRow(s.bounds, at, row, start, end, history, pose ? &pose->turned : nullptr, 1, total))
        total.touching |= 1u << boundary;
      base::Vec3d force = forceOf(s.bounds.impulse[s.now][at] - row.push * s.bounds.end[at].pull);
      if (pose) force = pushSurface(boundary - first, at, force, cross(point - pose->motion.centre, -force));
      add(row, force, s.bounds, at, !pose, total);
      const auto deep = static_cast<float>(s.bounds.end[at].overlap);
      if (deep > d.maxSurfaceShare * static_cast<float>(size.radius)) Step::raise(Fault::through, i);
    }
    if (total.touching != d.boundaryContactMask[i]) d.boundaryContactMask[i] = total.touching;
  }

  /// Ends the rows with parts, which receive exactly the opposite of the forces on the grain.
  GROUSER_HD void endPartRows(int i, const base::Position& p, const GrainSize<Real>& size, Total& total) const {
    const base::Vec3d x = base::toUnits(p).as<double>() * d.unitLength;
    forPartRowsOf(s, i, [&](int e, std::int64_t at) {
      const contact::PartPatches& patches = s.patches;
      const contact::PartMotion& part = patches.motion[patches.part(e)];
      const ImpulseRowRecord<Real> row = s.parts.row[at];
      const PartRowRecord<Real> on = s.parts.part[at];
      const base::Vec3d point = x - row.push.template as<double>() * static_cast<double>(row.armOwn);
      const BodyMotion<Real> body = s.bodyMotion[s.now][on.body];
      Relative start = between(motionAtStart<Real>(d, i), {}, row), end = between(motionAfter(i), {}, row);
      start.velocity -= part.velocityAt(point).template as<Real>(), start.spin -= part.spin.template as<Real>();
      end.velocity -= body.at(on.arm), end.spin -= body.spin;
      float history[6];
      storeVector(history, patches.memory[at].shear);
      storeVector(history + 3, patches.angle ? patches.angle[at] : base::Vec3f{});
      const bool touches = endRow(s.parts, at, row, start, end, history, &part.rotation, 1, total);
      if (touches)
        patches.memory[at].shear = loadVector(history), patches.count(contact::kPatchesNow, 1);
      else
        patches.memory[at] = {};
      if (patches.angle) patches.angle[at] = loadVector(history + 3);
      const base::Vec3l quanta =
          patches.model.force.quantise(forceOf(s.parts.impulse[s.now][at] - row.push * s.parts.end[at].pull));
      const base::Vec3d force = patches.model.force.value(quanta);
      base::Vec3d torque = cross(point - part.centre, -force);
      if (s.parts.rolling) torque -= forceOf(s.parts.turning[s.now][at]);
      patches.loadPart(e, quanta, torque);
      add(row, force, s.parts, at, false, total);
      const auto overlap = static_cast<float>(s.parts.end[at].overlap), radius = static_cast<float>(size.radius);
      if (overlap > patches.load[e].deepest) patches.noteOverlap(e, overlap, radius);
      if (overlap > radius) Step::raise(Fault::through, i);
    });
  }

  GROUSER_HD base::Vec3d forceOf(const Vec& impulse) const {
    return impulse.template as<double>() * (1.0 / d.timeStep);
  }

  GROUSER_HD void add(const ImpulseRowRecord<Real>& row, const base::Vec3d& force, const ImpulseRowsView<Real>& rows,
                      std::int64_t at, bool held, Total& total) const {
    base::Vec3d torque = cross(row.push.template as<double>(), force) * -static_cast<double>(row.armOwn);
    if (rows.rolling) torque += forceOf(rows.turning[s.now][at]);
    total.force += force, total.torque += torque;
    if (held) total.heldForce += force, total.heldTorque += torque;
  }

  /// Rounds a force on a grain to whole quanta, and applies exactly the opposite to the surface.
  GROUSER_HD base::Vec3d pushSurface(int surface, std::int64_t at, const base::Vec3d& force, base::Vec3d torque) const {
    const base::Vec3l quanta = d.surfaceForce.quantise(force);
    if (s.bounds.rolling) torque -= forceOf(s.bounds.turning[s.now][at]);
    Kernel::loadSurface(surface, quanta, torque);
    return d.surfaceForce.value(quanta);
  }

  /// Accounts for the energies of a row and stores its springs. `share`: fraction of its losses assigned to this grain
  /// [-]. Returns true if the contact is closed.
  GROUSER_HD bool endRow(const ImpulseRowsView<Real>& rows, std::int64_t at, const ImpulseRowRecord<Real>& row,
                         const Relative& start, const Relative& end, float* history, const base::Mat3d* turned,
                         double share, Total& total) const {
    const Vec x = rows.impulse[s.now][at], a = rows.gradient[s.now][at];
    const ImpulseRowEnd<Real> more = rows.end[at];
    const Vec slip = contact::detail::tangentOf(a, row.push);
    const Vec way = contact::detail::tangentOf(end.velocity, row.push) - slip; // rate of the shear spring [m/s]
    const Real along = dot(x, row.push);
    const Vec shear = x - row.push * along;
    const double first = static_cast<double>(dot(start.velocity, row.push)),
                 last = static_cast<double>(dot(end.velocity, row.push)), normal = static_cast<double>(along);
    const bool impact = rows.other[at].place & kImpactBit;
    // Friction dissipation uses the slip at the end of the step. Rigid contacts have no springs, so all tangential
    // work, which the mean velocity determines, is frictional.
    const Real mean = impact || s.rules.rigid ? Real(0.5) : Real(0);
    const Vec sped = contact::detail::tangentOf(end.velocity - start.velocity, row.push) * mean;
    total.lost.rubbed -= share * static_cast<double>(dot(shear, slip - sped));
    const double given = share * normal * 0.5 * (first + last);
    if (!impact && s.rules.rigid && more.overlap > 0 && given > 0)
      total.stabilised += given;
    else if (impact || s.rules.rigid)
      total.lost.damped -= given;
    else if (along > 0)
      total.lost.damped += share * d.timeStep *
                           (static_cast<double>(more.damping) * last * last +
                            static_cast<double>(more.shearDamping) * static_cast<double>(norm2(way)));
    if (rows.rolling) {
      const Vec r = rows.turning[s.now][at];
      const Vec turnSped = contact::detail::tangentOf(end.spin - start.spin, row.push) * mean;
      total.lost.rolled -= share * static_cast<double>(dot(r, rows.turnGradient[s.now][at] - turnSped));
      if (!impact && !s.rules.rigid && along > 0)
        total.lost.rolled +=
            share * d.timeStep * static_cast<double>(more.rollingDamping) *
            static_cast<double>(norm2(contact::detail::tangentOf(end.spin, row.push) - rows.turnGradient[s.now][at]));
    }
    total.lost.slipped += share * static_cast<double>(more.slipped);
    total.lost.rolled += share * static_cast<double>(more.rolled);
    const bool touches = along > 0 || more.overlap > 0;
    if (history && touches) keep(rows, at, row, end, way, history, turned);
    return touches;
  }

  GROUSER_HD void keep(const ImpulseRowsView<Real>& rows, std::int64_t at, const ImpulseRowRecord<Real>& row,
                       const Relative& end, const Vec& way, float* history, const base::Mat3d* turned) const {
    const Real h = s.rules.timeStep;
    Vec spring{}, angle{};
    if (s.rules.rigid) {
      spring = contact::keptImpulse(rows.impulse[s.now][at], s.rules);
      if (rows.rolling) angle = contact::keptImpulse(rows.turning[s.now][at], s.rules);
    } else if (!(rows.other[at].place & kImpactBit)) {
      // The spring stretches by the tangential displacement minus the slip.
      if (row.shearSoftness > 0) spring = turnedSpring<Real>(history, turned) + way * h;
      if (rows.rolling)
        angle = turnedSpring<Real>(history + 3, turned) +
                (contact::detail::tangentOf(end.spin, row.push) - rows.turnGradient[s.now][at]) * h;
    }
    storeTurned(history, turned, spring);
    if (rows.rolling) storeTurned(history + 3, turned, angle);
  }
};

} // namespace grouser::terrain
