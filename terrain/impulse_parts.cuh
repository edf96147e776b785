// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/impulse_setup.cuh"

namespace grouser::terrain {

/// Rows of one listed pair of grain and part. Their springs turn with the part.
template <class Real> struct MakePartRows : ImpulseKernel<Real> {
  static constexpr double kNanoseconds = 400;
  using Base = ImpulseKernel<Real>;
  using Base::d, Base::s;
  using typename Base::Arms, typename Base::Kernel, typename Base::Law, typename Base::Touch, typename Base::Vec;

  GROUSER_HD void operator()(int e) const {
    const contact::PartPatches& patches = s.patches;
    const int i = static_cast<int>(patches.slot[e]);
    const GrainSize<Real> size = Kernel::sizeOf(i);
    const contact::PartMotion& part = patches.motion[patches.part(e)];
    const base::Vec3d x = patches.centre(e);
    const double speed = Base::speedOf(i) + 2 * norm(d.gravityStep) + norm(part.velocityAt(x));
    const contact::PartPatches::Found found =
        patches.find(e, static_cast<double>(Base::marginFor(speed)) * d.unitLength);
    s.partRows[e] = 0;
    patches.load[e] = {};
    if (found.through > 0) Base::raise(Fault::through, i);
    contact::PatchMemory fresh[contact::kPatches] = {};
    base::Vec3f angle[contact::kPatches] = {};
    double elastic = 0;
    for (int k = 0; k < found.count; ++k) {
      // Fixed grains have no rows: a part that reaches one is a fault.
      if (hasNoRows(d, s, i)) {
        if (found.patch[k].overlap > 0) Base::raise(Fault::through, i);
        continue;
      }
      elastic += add(e, k, x, size, found, fresh[k], angle[k]);
    }
    const std::int64_t first = contact::PartPatches::first(e);
    for (int k = 0; k < contact::kPatches; ++k) {
      patches.memory[first + k] = fresh[k];
      if (patches.angle) patches.angle[first + k] = angle[k];
    }
    if (hasNoRows(d, s, i) || found.count == 0) return;
    s.partRows[e] = static_cast<std::uint32_t>(found.count);
    base::atomicAdd32(s.bodyRows + s.bodyOfPart[patches.part(e)], static_cast<std::uint32_t>(found.count));
    patches.count(contact::kElasticNow, patches.model.energy.quantise(elastic));
  }

private:
  /// Adds the row of a patch. Returns the energy in its springs [J].
  GROUSER_HD double add(int e, int k, const base::Vec3d& x, const GrainSize<Real>& size,
                        const contact::PartPatches::Found& found, contact::PatchMemory& kept,
                        base::Vec3f& keptAngle) const {
    const contact::PartPatches& patches = s.patches;
    const contact::PartMotion& part = patches.motion[patches.part(e)];
    const contact::TouchedPatch& patch = found.patch[k];
    const std::uint32_t body = s.bodyOfPart[patches.part(e)];
    const Law& law = s.partLaws[patches.law(e, size.material)];
    const base::Vec3d outward = part.rotation * patch.normal.template as<double>();
    Touch touch{};
    touch.push = outward.template as<Real>(), touch.gap = -static_cast<Real>(patch.overlap);
    const Arms arms{size.radius + (touch.gap < 0 ? touch.gap : Real(0)), Real(0)};
    const base::Vec3d point = x - outward * static_cast<double>(arms.own);
    const PartRowRecord<Real> on{(point - part.centre).template as<Real>(), body};
    const Vec moves = part.velocityAt(point).template as<Real>();
    const ImpulseMotion<Real> mine = motionAtStart<Real>(d, static_cast<int>(patches.slot[e]));
    touch.velocity = relativeVelocity(mine, {}, touch.push, arms.own, arms.other) - moves;
    touch.spin = mine.spin - part.spin.template as<Real>();
    touch.freely = dot(d.gravityStep.template as<Real>() - (s.bodyMotion[body].at(on.arm) - moves), touch.push);
    touch.effectiveMass = size.mass, touch.effectiveRadius = size.radius;
    touch.rollingInertia = contact::rollingInertia(size.mass, size.radius);
    touch.dampingShare = 1;
    touch.held = found.former[k] >= 0;
    const std::int64_t former = contact::PartPatches::first(e) + (touch.held ? found.former[k] : 0);
    float history[6] = {};
    if (touch.held) storeVector(history, patches.memory[former].shear);
    if (touch.held && patches.angle) storeVector(history + 3, patches.angle[former]);
    Base::takeSprings(history, &part.rotation, patches.angle != nullptr, touch);
    kept = {patch.normal, loadVector(history)}, keptAngle = loadVector(history + 3);
    const std::int64_t at = contact::PartPatches::first(e) + k;
    Base::put(s.parts, at, contact::impulseRow(law, touch, s.rules), arms, static_cast<Real>(patch.overlap),
              kFixedPartner, static_cast<std::uint32_t>(k));
    s.parts.part[at] = on;
    return s.rules.rigid || !(patch.overlap > 0) ? 0
                                                 : springEnergy(law, touch, patch.overlap, patches.angle != nullptr);
  }

  GROUSER_HD static double springEnergy(const Law& law, const Touch& touch, float overlap, bool rolls) {
    const double radius = static_cast<double>(touch.effectiveRadius);
    double energy = contact::storedEnergy(law, static_cast<double>(overlap), radius, touch.shear);
    if (!rolls) return energy;
    const auto c = contact::coefficientsOf<contact::kGeneral>(law, static_cast<Real>(overlap), touch.effectiveMass,
                                                              touch.effectiveRadius);
    const Real k = contact::rollingStiffness(law, c.normalStiffness, touch.effectiveRadius);
    return energy + 0.5 * static_cast<double>(k * dot(touch.angle, touch.angle));
  }
};

} // namespace grouser::terrain
