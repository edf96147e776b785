// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/impulse_setup.cuh"

namespace grouser::terrain {

/// Creates the rows of a listed grain-part pair. Springs rotate with the part.
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
    // Fixed grains have no rows: contact between a part and a fixed grain is a fault.
    const int rows = hasNoRows(d, s, i) ? 0 : found.count;
    for (int k = rows; k < found.count; ++k)
      if (found.patch[k].overlap > 0) Base::raise(Fault::through, i);
    if (found.through > 0) Base::raise(Fault::through, i);
    patches.load[e] = {};
    contact::PatchMemory fresh[contact::kPatches] = {};
    base::Vec3f angle[contact::kPatches] = {};
    double elastic = 0;
    for (int k = 0; k < rows; ++k) elastic += add(e, k, x, size, found, fresh[k], angle[k]);
    const std::int64_t first = contact::PartPatches::first(e);
    for (int k = 0; k < contact::kPatches; ++k) {
      patches.memory[first + k] = fresh[k];
      if (patches.angle) patches.angle[first + k] = angle[k];
    }
    s.partRows[e] = static_cast<std::uint32_t>(rows);
    if (rows == 0) return;
    base::atomicAdd32(s.bodyRows + s.bodyOfPart[patches.part(e)], static_cast<std::uint32_t>(rows));
    patches.count(contact::kElasticNow, patches.model.energy.quantise(elastic));
  }

private:
  /// Adds the row of a patch. Returns its spring energy [J].
  GROUSER_HD double add(int e, int k, const base::Vec3d& x, const GrainSize<Real>& size,
                        const contact::PartPatches::Found& found, contact::PatchMemory& kept,
                        base::Vec3f& keptAngle) const {
    const contact::PartPatches& patches = s.patches;
    const contact::PartMotion& part = patches.motion[patches.part(e)];
    const contact::TouchedPatch& patch = found.patch[k];
    const std::uint32_t body = s.bodyOfPart[patches.part(e)];
    const Law& law = s.partLaws[patches.law(e, size.material)];
    const base::Vec3d outward = part.rotation * patch.normal.template as<double>();
    const Vec push = outward.template as<Real>();
    const Real gap = -static_cast<Real>(patch.overlap);
    const Arms arms = Base::armsOf(size, gap);
    const base::Vec3d point = x - outward * static_cast<double>(arms.own);
    const PartRowRecord<Real> on{(point - part.centre).template as<Real>(), body};
    const Vec moves = part.velocityAt(point).template as<Real>();
    Touch touch = Base::touchOf(static_cast<int>(patches.slot[e]), size, push, gap, arms, moves,
                                part.spin.template as<Real>(), s.bodyMotion[s.now][body].at(on.arm) - moves);
    touch.held = found.former[k] >= 0;
    const std::int64_t former = contact::PartPatches::first(e) + (touch.held ? found.former[k] : 0);
    float history[6] = {};
    if (touch.held) storeVector(history, patches.memory[former].shear);
    if (touch.held && patches.angle) storeVector(history + 3, patches.angle[former]);
    touch.movedMass = Real(1) / (Real(1) / size.mass + Base::mobilityOf(s.body[body], on.arm));
    Base::takeSprings(history, &part.rotation, patches.angle != nullptr, law, touch);
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
