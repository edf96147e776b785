// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_step.cuh"

/// A grain's step split into two kernels, with the same bits as GrainStep. Contacts between grains do not depend on the
/// vehicle, so a GPU computes them while it waits for the vehicle's poses. Single precision only.
namespace grouser::terrain {

/// Sums the contacts of each grain with other grains.
template <unsigned kFeatures> struct GatherContacts : GrainStep<kFeatures, float> {
  using Step = GrainStep<kFeatures, float>;
  using Step::d, Step::has;
  /// Limits a thread to 64 or 72 registers. Memory latency bounds this kernel, so higher occupancy outweighs spills.
  static constexpr int kBlocksTogether = kFeatures & contact::kHertz ? 8 : 7;

  GROUSER_HD void operator()(int i) const {
    if (Step::ended()) return;
    const base::Position p = d.position[i];
    const Motion m = d.motion[i];
    if (has(kFixed) && isFixed(m.velocity)) return;
    typename Step::Sum sum;
    Step::gather(i, p, m, sum);
    const base::Vec3f &force = sum.force, &torque = sum.torque;
    d.gathered[i] = {{force.x, force.y, force.z, sum.deepest},
                     {torque.x, torque.y, torque.z, sum.damped},
                     {sum.rubbed, sum.rolled, sum.slipped, 0}};
  }
};

/// Adds all other forces to these sums, and advances each grain.
template <unsigned kFeatures> struct AdvanceGathered : GrainStep<kFeatures, float> {
  using Step = GrainStep<kFeatures, float>;
  using Step::d, Step::has;
  using Books = typename Step::Books;

  GROUSER_HD void operator()(int i) const {
    Books books;
    run(i, books);
  }
  GROUSER_HD void run(int i, Books& books) const {
    if (Step::ended()) return Step::skip(i);
    const base::Position p = d.position[i];
    const Motion m = d.motion[i];
    if (has(kFixed) && isFixed(m.velocity)) return Step::stay(i, p, m);
    const auto [force, torque, lost] = d.gathered[i];
    typename Step::Sum sum;
    sum.force = force.xyz(), sum.deepest = force.w;
    sum.torque = torque.xyz(), sum.damped = torque.w;
    sum.rubbed = lost.x, sum.rolled = lost.y, sum.slipped = lost.z;
    Step::finish(i, p, m, sum, books);
  }
};

} // namespace grouser::terrain
