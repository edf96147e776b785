// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_kernel_data.cuh"

namespace grouser::terrain {

/// Walls and floor on the grains near them. A kernel of its own: the search on the floor needs many registers, and only
/// one layer of grains needs the search.
template <unsigned kFeatures, class Real> struct BoundaryContacts : GrainKernel<kFeatures, Real> {
  using Kernel = GrainKernel<kFeatures, Real>;
  using Kernel::d, Kernel::f, Kernel::has;
  using Vec = base::Vec3<Real>;

  GROUSER_HD void operator()(int k) const {
    const int i = static_cast<int>(d.nearBoundary[k]);
    const Vec v = d.velocity[i].xyz().template as<Real>(), w = d.spin[i].xyz().template as<Real>();
    const base::Vec3d x = base::toUnits(d.position[i]).template as<double>() * d.unitLength;
    const GrainSize<Real> size = Kernel::sizeOf(i);
    const double radius = static_cast<double>(size.radius);
    BoundaryLoad<Real> sum{};
    const std::uint32_t before = d.wallTouching[i];
    std::uint32_t now = 0;
    for (int b = 0; b < d.wallCount; ++b) {
      const double distance = dot(d.walls[b].normal, x) - d.walls[b].offset;
      const Real overlap = static_cast<Real>(radius - distance);
      if (overlap <= 0) continue;
      now |= 1u << b;
      touch(i, b, size, before, d.walls[b].normal.template as<Real>(), overlap, v, w, sum);
    }
    if (d.hasFloor && !d.floor.clearOf(x, radius)) {
      const FootPoint foot = d.floor.closestPoint(x);
      const Real overlap = static_cast<Real>(radius - foot.distance);
      if (overlap > 0) {
        now |= 1u << d.wallCount;
        touch(i, d.wallCount, size, before, foot.normal.template as<Real>(), overlap, v, w, sum);
      }
    }
    if (now != before) d.wallTouching[i] = now;
    f.boundaryLoads[k] = sum;
  }

private:
  GROUSER_HD void touch(int i, int boundary, const GrainSize<Real>& size, std::uint32_t before, const Vec& outward,
                        Real overlap, const Vec& v, const Vec& w, BoundaryLoad<Real>& sum) const {
    const contact::BasicLaw<Real>& law = f.boundaryLaws[boundary * d.materials + size.material];
    const Vec normal = -outward; // from the grain to the wall
    const Vec arm = normal * (size.radius - overlap);
    const contact::BasicTouch<Real> touch{normal, overlap, v + cross(w, arm), size.mass, size.radius};
    const bool held = Kernel::hasHistory() && (before >> boundary & 1);
    float* history =
        Kernel::hasHistory()
            ? d.wallHistory + (static_cast<std::int64_t>(i) * d.boundaryCount + boundary) * Kernel::historyWidth()
            : nullptr;
    Vec shear{};
    if (held) shear = loadVector(history).template as<Real>();
    const auto reaction = contact::contactForce<Kernel::kLaw>(law, touch, f.timeStep, shear);
    if (Kernel::hasHistory()) storeVector(history, shear.template as<float>());
    sum.force += reaction.force;
    if (has(contact::kFriction)) sum.torque += cross(arm, reaction.force);
    sum.dissipated += reaction.dissipated;
    if (has(contact::kRollingFriction)) {
      Vec angle{};
      if (held) angle = loadVector(history + 3).template as<Real>();
      const contact::RollingMotion<Real> motion{normal, w, size.radius,
                                                Real(1.4) * size.mass * size.radius * size.radius};
      sum.torque += contact::rollingTorque(law, motion, reaction.pressing, reaction.normalStiffness, f.timeStep, angle,
                                           sum.dissipated);
      storeVector(history + 3, angle.template as<float>());
    }
    if (overlap > sum.deepest) sum.deepest = overlap;
  }
};

} // namespace grouser::terrain
