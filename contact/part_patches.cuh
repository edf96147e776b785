// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/grain_part_kernel.cuh"

namespace grouser::contact {

/// Interface of listed grain-part pairs for the complementarity solver: finds the patches of a pair with their gaps,
/// stores their history, and sums their loads.
struct PartPatches : GrainPartForces<kGeneral> {
  const std::uint32_t* range; ///< by slot; see GrainLoadsView
  std::int64_t pairs;

  struct Found {
    int count = 0;
    TouchedPatch patch[kPatches]; ///< `overlap` < 0: a gap [m]
    int former[kPatches];         ///< index in the memory of the previous step; -1: new patch
    float through = 0;            ///< see recallAll() [m]
  };
  /// Finds the patches of a pair with gaps below `gap` [m], which must not exceed GrainPartModel::gap.
  GROUSER_HD Found find(int e, double gap) const {
    const Ball ball = ballOf(static_cast<int>(slot[e]));
    Found found;
    found.count = touch(parts[partOf(e)], motion[partOf(e)].toPart(ball.x), ball.radius + gap, base::ThreadGroup<1>{0},
                        found.patch);
    for (int k = 0; k < found.count; ++k) found.patch[k].overlap -= static_cast<float>(gap);
    found.through =
        recallAll(memory + first(e), found.patch, found.count, static_cast<float>(ball.radius), found.former);
    return found;
  }
  GROUSER_HD int part(int e) const { return partOf(e); }
  GROUSER_HD std::uint32_t grain(int e) const { return static_cast<std::uint32_t>(key[e] >> 16); }
  GROUSER_HD base::Vec3d centre(int e) const { return ballOf(static_cast<int>(slot[e])).x; }
  GROUSER_HD int law(int e, int material) const { return parts[partOf(e)].firstLaw + material; }
  /// Index of a pair's first patch in the memory and angle arrays.
  GROUSER_HD static std::int64_t first(int e) { return static_cast<std::int64_t>(e) * kPatches; }

  /// Adds the opposite of `quanta`, the force on a grain, and of `torque` [N m] about its centre to a part.
  GROUSER_HD void loadPart(int e, const base::Vec3l& quanta, const base::Vec3d& torque) const {
    addTo(partLoad[partOf(e)].force, -quanta);
    addTo(partLoad[partOf(e)].torque, model.torque.quantise(torque));
    for (int a = 0; a < 3; ++a) base::atomicAdd64(sums + kReceivedByGrains + a, quanta[a]);
  }
  GROUSER_HD void count(PartSum which, std::int64_t value) const { base::atomicAdd64(sums + which, value); }
  /// Records the overlap of a grain with a part [m].
  GROUSER_HD void noteOverlap(int e, float overlap, float radius) const {
    load[e].deepest = overlap;
    if (overlap > static_cast<float>(kDeepOverlap) * radius) count(kDeepOverlapsNow, 1);
    if (overlap > 0) base::atomicMin64(pressed + partOf(e), pressKey(overlap / radius, grain(e)));
  }
};

} // namespace grouser::contact
