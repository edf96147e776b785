// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/bits.hpp"
#include "base/for_each_group.cuh"
#include "contact/contact_moment.hpp"
#include "contact/crushing.hpp"
#include "contact/grain_loads.hpp"
#include "contact/grain_part_model.hpp"
#include "contact/grains_view.hpp"
#include "contact/part_motion.hpp"
#include "contact/part_surface.hpp"
#include "contact/rolling_resistance.hpp"

#include <type_traits>

/// Contacts of one grain with one part: the patches, their springs, and the loads on both.
namespace grouser::contact {

inline constexpr float kSameNormal = 0.9f; // cosine: contacts within 26 degrees belong to one patch
inline constexpr float kSameFace = 0.97f;  // cosine: discs of one face belong to one patch
inline constexpr float kSamePatch = 0.8f;  // cosine: a patch is identified with one of the previous step
inline constexpr float kOtherSide = -0.5f; // cosine: a patch on the far side of the part

/// Key for atomicMin: the minimum selects the largest overlap / radius; among equal ratios, the lowest grain id.
GROUSER_HD std::uint64_t pressKey(float share, std::uint32_t grain) {
  return static_cast<std::uint64_t>(~base::bitsAs<std::uint32_t>(share)) << 32 | grain;
}
inline constexpr std::uint64_t kNotPressed = ~std::uint64_t{0};

/// Patch of the current step, before it is matched to the patches of the previous step.
struct TouchedPatch {
  base::Vec3f normal; ///< outward from the part, in its frame
  base::Vec3f face;   ///< plane normal of the deepest disc
  float overlap;
};

/// Adds to the shared sums immediately.
struct AddAtOnce {
  std::int64_t* sums;
  GROUSER_HD void add(int which, std::int64_t value) const { base::atomicAdd64(sums + which, value); }
};
/// Accumulates over many pairs before adding: frequent atomics on one address are slow.
struct AddLater {
  std::int64_t of[kPartSums] = {};
  GROUSER_HD void add(int which, std::int64_t value) { of[which] += value; }
};

/// Computes the loads of one listed pair, with one thread or with a group of threads that share its discs.
template <unsigned kFeatures> struct GrainPartForces {
  static constexpr double kNanoseconds = 170;
  GrainPartModel model;
  const BasicLaw<float>* laws;
  const double* massPerCube;
  GrainsView grains;
  const PartMotion* motion;
  const GrainPart* parts;
  const SurfaceGridView* grids;
  const std::uint64_t* key;
  const std::uint32_t* slot;
  PatchMemory* memory;
  base::Vec3f* angle;       ///< null without rolling friction
  const Crushing* crushing; ///< one per law; null if no grain crushes
  float* dent;              ///< dent per patch [m]; null if no grain crushes
  std::int64_t* energyHeld; ///< spring energy per pair [quanta]; null if no grain crushes
  int endedAt;              ///< index of the entry after the part loads; its force.x counts crushed grains
  GrainLoad* load;
  PartLoad* partLoad;
  std::int64_t* sums;       ///< [kPartSums]
  std::uint64_t* pressed;   ///< per part: key of the grain with the largest overlap: see pressKey()
  const std::uint32_t* off; ///< nonzero: cancelled, see base::Gate; null: never

  template <class Group> GROUSER_HD void operator()(int e, const Group& group) const {
    if (calledOff()) return;
    const AddAtOnce shared{sums};
    run(e, group, shared);
  }
  GROUSER_HD bool calledOff() const { return off && *off; }
  /// True if the grain may be in contact with the part.
  GROUSER_HD bool isNear(int e) const {
    const PartMotion& part = motion[partOf(e)];
    const GrainPart& of = parts[partOf(e)];
    const Ball ball = ballOf(static_cast<int>(slot[e]));
    const base::Vec3d c = part.toPart(ball.x);
    if (of.surface < 0) return gapTo(of.shape, c).distance < ball.radius;
    const SurfaceGridView& grid = grids[of.surface];
    const std::int64_t cell = grid.cellAt(c);
    if (cell < 0) return false;
    for (std::uint32_t k = grid.start[cell]; k < grid.start[cell + 1]; ++k)
      if (!outOfReach(grid.disc[grid.entry[k]], c, ball.radius)) return true;
    return false;
  }
  /// Clears the history and load of a pair out of range. Angles and dents of free entries are never read.
  GROUSER_HD void release(int e) const {
    for (int k = 0; k < kPatches; ++k) memory[static_cast<std::int64_t>(e) * kPatches + k] = {};
    if (crushes()) energyHeld[e] = 0;
    load[e] = {};
  }
  /// Processes a thread's pairs on a CPU.
  void runOnCpu(std::int64_t firstPair, std::int64_t endPair) const {
    AddLater kept;
    for (std::int64_t e = firstPair; e < endPair; ++e) run(static_cast<int>(e), base::ThreadGroup<1>{0}, kept);
    for (int k = 0; k < kPartSums; ++k)
      if (kept.of[k] != 0) base::atomicAdd64(sums + k, kept.of[k]);
  }

protected:
  GROUSER_HD int partOf(int e) const { return static_cast<int>(key[e] & 0xFFFFu); }
  template <class Group, class Sums> GROUSER_HD void run(int e, const Group& group, Sums& total) const {
    const int i = static_cast<int>(slot[e]);
    const int p = partOf(e);
    const PartMotion part = motion[p];
    const Ball ball = ballOf(i);
    const GrainPart& of = parts[p];
    TouchedPatch patches[kPatches];
    const int found = touch(of, part.toPart(ball.x), ball.radius, group, patches);
    if (group.rank != 0) return; // one thread completes the pair
    PatchMemory* held = memory + static_cast<std::int64_t>(e) * kPatches;
    int former[kPatches];
    PairLoad sum;
    sum.onGrain.deepest = recallAll(held, patches, found, static_cast<float>(ball.radius), former);
    PatchMemory fresh[kPatches] = {};
    base::Vec3f freshAngle[kPatches] = {};
    float freshDent[kPatches] = {};
    base::Vec3f* heldAngle = rolls() ? angle + static_cast<std::int64_t>(e) * kPatches : nullptr;
    float* heldDent = crushes() ? dent + static_cast<std::int64_t>(e) * kPatches : nullptr;
    for (int k = 0; k < found; ++k) {
      fresh[k] = {patches[k].normal, former[k] < 0 ? base::Vec3f{} : held[former[k]].shear};
      if (rolls() && former[k] >= 0) freshAngle[k] = heldAngle[former[k]];
      if (crushes() && former[k] >= 0) freshDent[k] = heldDent[former[k]];
      apply(part, of.firstLaw + ball.material, ball, patches[k], {fresh[k].shear, freshAngle[k], freshDent[k]}, sum);
    }
    for (int k = 0; k < kPatches; ++k) {
      held[k] = fresh[k];
      if (rolls()) heldAngle[k] = freshAngle[k];
      if (crushes()) heldDent[k] = freshDent[k];
    }
    const float share = sum.onGrain.deepest / static_cast<float>(ball.radius);
    if (crushes()) {
      energyHeld[e] = model.energy.quantise(sum.elastic);
      if (share >= 1 && mayCrush(of.firstLaw + ball.material, ball)) {
        // Crushed to its centre: the host removes the grain before the next step.
        sum.onGrain.deepest = -sum.onGrain.deepest;
        base::atomicAdd64(&partLoad[endedAt].force.x, 1);
      }
    }
    load[e] = sum.onGrain;
    if (found == 0) return;
    addTo(partLoad[p].force, -sum.onGrain.force);
    addTo(partLoad[p].torque, sum.torqueOnPart);
    total.add(kPatchesNow, found);
    total.add(kElasticNow, model.energy.quantise(sum.elastic));
    for (int cause = 0; cause < 4; ++cause)
      total.add(kDampedByParts + cause, model.energy.quantise(static_cast<double>(sum.lost[cause])));
    if (crushes()) {
      total.add(kCappedNow, sum.capped);
      total.add(kCrushedByParts, model.energy.quantise(sum.crushed));
      total.add(kCutByCrushing, model.force.quantise(sum.cut));
    }
    if (share > static_cast<float>(kDeepOverlap)) total.add(kDeepOverlapsNow, 1);
    base::atomicMin64(pressed + p, pressKey(share, static_cast<std::uint32_t>(key[e] >> 16)));
  }

  /// Grain of a pair.
  struct Ball {
    base::Vec3d x, v, w;
    double radius, mass;
    int material;
    bool fixed; ///< fixed in place; does not crush
  };
  /// History of a patch, updated by its force.
  struct Springs {
    base::Vec3f& shear;
    base::Vec3f& rolled; ///< rolling angle [rad]
    float& dent;         ///< dent of a crushing grain [m]
  };
  /// Sums over the patches of a pair.
  struct PairLoadOfStep {
    GrainLoad onGrain{};
    base::Vec3l torqueOnPart{};
    double elastic = 0;          ///< stored in springs [J]
    float lost[4] = {};          ///< dissipated by dashpots, sliding, rolling resistance, stiffness changes [J]
    double crushed = 0, cut = 0; ///< dissipated by crushing [J], force removed by the cap [N]
    int capped = 0;              ///< number of patches
  };
  struct MeasuredPairLoad : PairLoadOfStep {
    ContactMoment moment;
  };
  using PairLoad = std::conditional_t<(kFeatures & kMeasured) != 0, MeasuredPairLoad, PairLoadOfStep>;

  GROUSER_HD bool rolls() const { return (kFeatures & (kGeneral | kRollingFriction)) && angle; }
  GROUSER_HD bool crushes() const { return (kFeatures & kGeneral) && crushing; }
  GROUSER_HD bool mayCrush(int lawIndex, const Ball& ball) const {
    return crushes() && !ball.fixed && crushing[lawIndex].strength > 0;
  }

  GROUSER_HD Ball ballOf(int i) const {
    const base::Vec4f velocity = grains.motion[i].velocity, spin = grains.motion[i].spin;
    Ball ball{model.scale.toMetres(grains.position[i]),
              velocity.xyz().template as<double>(),
              spin.xyz().template as<double>(),
              model.radius,
              model.mass,
              0,
              velocity.w < 0};
    if (!model.manyRadii) return ball;
    ball.material = static_cast<int>(spin.w);
    const double r = fabs(static_cast<double>(velocity.w)); // negative for a fixed grain
    ball.radius = r, ball.mass = massPerCube[ball.material] * r * r * r;
    return ball;
  }

  GROUSER_HD static void addTo(base::Vec3l& target, const base::Vec3l& value) {
    base::atomicAdd64(&target.x, value.x);
    base::atomicAdd64(&target.y, value.y);
    base::atomicAdd64(&target.z, value.z);
  }

  /// Finds the patches of a part in contact with a sphere centred at `c` in the part frame.
  template <class Group> GROUSER_HD int touch(const GrainPart& of, const base::Vec3d& c, double ballRadius,
                                              const Group& group, TouchedPatch* patches) const {
    return of.surface < 0 ? touchShape(of.shape, c, ballRadius, patches)
                          : findPatches(grids[of.surface], c, ballRadius, group, patches);
  }

  /// Finds the patch at the nearest point of a convex shape.
  GROUSER_HD static int touchShape(const SurfaceGeometry& shape, const base::Vec3d& c, double ballRadius,
                                   TouchedPatch* patches) {
    const SurfaceGap gap = gapTo(shape, c);
    const float overlap = static_cast<float>(ballRadius - gap.distance);
    if (overlap <= 0) return 0;
    const base::Vec3f normal = gap.normal.template as<float>();
    patches[0] = {normal, normal, overlap};
    return 1;
  }

  /// Finds the deepest contact first, then repeatedly the deepest contact outside all patches found so far.
  template <class Group> GROUSER_HD int findPatches(const SurfaceGridView& grid, const base::Vec3d& c,
                                                    double ballRadius, const Group& group,
                                                    TouchedPatch* patches) const {
    const std::int64_t cell = grid.cellAt(c);
    if (cell < 0) return 0;
    const float radius = static_cast<float>(ballRadius);
    const std::uint32_t first = grid.start[cell], last = grid.start[cell + 1];
    int found = 0;
    for (; found < kPatches; ++found) {
      float deepest = 0;
      std::uint32_t at = last;
      for (std::uint32_t k = first + static_cast<std::uint32_t>(group.rank); k < last; k += Group::width) {
        const Disc& disc = grid.disc[grid.entry[k]];
        if (outOfReach(disc, c, ballRadius)) continue;
        const DiscDistance d = distanceTo(disc, c);
        const float overlap = radius + disc.radius - d.distance;
        if (overlap <= deepest) continue;
        bool taken = false;
        for (int q = 0; q < found; ++q)
          taken =
              taken || dot(d.normal, patches[q].normal) > kSameNormal || dot(disc.normal, patches[q].face) > kSameFace;
        if (!taken) deepest = overlap, at = k;
      }
      group.agreeOnGreatest(deepest, at);
      if (deepest <= 0) break;
      const Disc& disc = grid.disc[grid.entry[at]];
      patches[found] = {distanceTo(disc, c).normal, disc.normal, deepest};
    }
    return found;
  }

  /// Returns the patch of the previous step with the nearest normal; -1 if there is none.
  GROUSER_HD static int recall(const PatchMemory* held, const base::Vec3f& normal, unsigned& used) {
    int best = -1;
    float alignment = kSamePatch;
    for (int k = 0; k < kPatches; ++k) {
      const float cosine = dot(held[k].normal, normal);
      if (!(used >> k & 1) && cosine > alignment) best = k, alignment = cosine;
    }
    if (best >= 0) used |= 1u << best;
    return best;
  }

  /// Matches the current patches to those of the previous step (-1: no match). Returns 0, or the depth of a grain that
  /// has passed through a thin part within this step (a deep new contact on the far side). Such a grain counts as
  /// pressed beyond its centre.
  GROUSER_HD static float recallAll(const PatchMemory* held, const TouchedPatch* patches, int found, float radius,
                                    int* former) {
    unsigned used = 0;
    for (int k = 0; k < found; ++k) former[k] = recall(held, patches[k].normal, used);
    float through = 0;
    for (int k = 0; k < found; ++k) {
      if (former[k] >= 0 || patches[k].overlap < 0.5f * radius) continue;
      for (int q = 0; q < kPatches; ++q)
        if (!(used >> q & 1) && dot(held[q].normal, patches[k].normal) < kOtherSide)
          through = radius + patches[k].overlap;
    }
    return through;
  }

  /// Reduces the overlap of a crushing contact to its elastic part. Returns false if the surfaces are apart in the
  /// dent; the energy of the tangential spring then counts as sliding dissipation.
  GROUSER_HD static bool crush(const Crushing& crushing, ContactGeometry& touch, const Springs& springs, float dt,
                               BasicLaw<float>& law, PairLoad& sum) {
    const Yielded y = yieldContact<kFeatures>(crushing, law, touch.overlap, dot(touch.velocity, touch.normal), dt,
                                              touch.effectiveMass, touch.effectiveRadius, springs.dent);
    sum.crushed += static_cast<double>(y.dissipated), sum.cut += static_cast<double>(y.cut);
    sum.capped += y.capped ? 1 : 0;
    if (y.overlap <= 0) {
      if (!law.hertz) sum.lost[1] += 0.5f * law.tangentialStiffness * dot(springs.shear, springs.shear);
      springs.shear = springs.rolled = {};
      return false;
    }
    touch.overlap = y.overlap, touch.crushes = y.capped;
    law.damping *= y.damping, law.rootDamping *= y.damping;
    return true;
  }

  /// Computes the force of one patch in the part frame, like the history, then quantises it in world axes.
  GROUSER_HD void apply(const PartMotion& part, int lawIndex, const Ball& ball, const TouchedPatch& patch,
                        const Springs& springs, PairLoad& sum) const {
    if (patch.overlap > sum.onGrain.deepest) sum.onGrain.deepest = patch.overlap;
    const BasicLaw<float>* law = laws + lawIndex;
    const base::Vec3d outward = part.rotation * patch.normal.template as<double>();
    const base::Vec3d arm = outward * -(ball.radius - static_cast<double>(patch.overlap));
    const base::Vec3d point = ball.x + arm;
    const base::Vec3d relative = ball.v + cross(ball.w, arm) - part.velocityAt(point);
    const float mass = static_cast<float>(ball.mass), radius = static_cast<float>(ball.radius);
    const float dt = static_cast<float>(model.timeStep);
    ContactGeometry touch{-patch.normal, patch.overlap, transposedTimes(part.rotation, relative).template as<float>(),
                          mass, radius};
    BasicLaw<float> yielding;
    if (mayCrush(lawIndex, ball)) {
      yielding = *law;
      if (!crush(crushing[lawIndex], touch, springs, dt, yielding, sum)) return;
      law = &yielding;
    }
    const Reaction reaction = contactForce<kFeatures>(*law, touch, dt, springs.shear);
    const base::Vec3l quanta = model.force.quantise(part.rotation * reaction.force.template as<double>());
    const base::Vec3d force = model.force.value(quanta);
    sum.onGrain.force += quanta;
    sum.onGrain.torque += cross(arm, force).template as<float>();
    if constexpr ((kFeatures & kMeasured) != 0) sum.moment.add(force, arm);
    sum.lost[0] += reaction.damped, sum.lost[1] += reaction.rubbed;
    sum.lost[3] += reaction.slipped;
    sum.elastic += storedEnergy(*law, static_cast<double>(touch.overlap), ball.radius, springs.shear);
    sum.torqueOnPart += model.torque.quantise(cross(point - part.centre, -force));
    if ((kFeatures & (kGeneral | kRollingFriction)) && law->rollingFriction > 0) {
      const base::Vec3f rolling = transposedTimes(part.rotation, ball.w - part.spin).template as<float>();
      const RollingMotion<float> how{touch.normal, rolling, radius, rollingInertia(mass, radius)};
      const base::Vec3f torque = rollingTorque(*law, how, reaction.pressing, reaction.normalStiffness, dt,
                                               springs.rolled, sum.lost[2], law->hertz ? &reaction.change : nullptr);
      const float k = rollingStiffness(*law, reaction.normalStiffness, radius);
      sum.elastic += 0.5 * static_cast<double>(k * dot(springs.rolled, springs.rolled));
      // Quantised on both sides, so that angular momentum balances exactly except for the grain's float torque.
      const base::Vec3l turned = model.torque.quantise(part.rotation * torque.template as<double>());
      sum.onGrain.torque += model.torque.value(turned).template as<float>();
      sum.torqueOnPart -= turned;
    }
  }
};

/// Contact moments of the listed pairs, in any order; does not change the history.
struct MeasurePairs : GrainPartForces<kGeneral | kMeasured> {
  ContactMoment* moments;
  GROUSER_HD void operator()(int e) const {
    const PartMotion& part = motion[partOf(e)];
    const GrainPart& of = parts[partOf(e)];
    const Ball ball = ballOf(static_cast<int>(slot[e]));
    TouchedPatch patches[kPatches];
    const int found = touch(of, part.toPart(ball.x), ball.radius, base::ThreadGroup<1>{0}, patches);
    const std::int64_t first = static_cast<std::int64_t>(e) * kPatches;
    int former[kPatches];
    recallAll(memory + first, patches, found, static_cast<float>(ball.radius), former);
    PairLoad sum;
    for (int k = 0; k < found; ++k) {
      const std::int64_t at = first + former[k];
      base::Vec3f shear, rolled;
      float dented = 0;
      if (former[k] >= 0) {
        shear = memory[at].shear;
        if (rolls()) rolled = angle[at];
        if (crushes()) dented = dent[at];
      }
      apply(part, of.firstLaw + ball.material, ball, patches[k], {shear, rolled, dented}, sum);
    }
    moments[e] = sum.moment;
  }
};

/// Lists the near pairs and clears all others, with one thread and few registers per pair: in fine soils most listed
/// pairs are out of range, and this test is cheaper than the 16 threads per pair of GrainPartForces.
template <unsigned kFeatures> struct FindNearPairs {
  static constexpr double kNanoseconds = 100;
  GrainPartForces<kFeatures> forces;
  std::uint32_t *near, *count;
  GROUSER_HD void operator()(int e) const {
    if (forces.calledOff()) return;
    if (forces.isNear(e))
      near[base::atomicAdd32(count, 1)] = static_cast<std::uint32_t>(e);
    else
      forces.release(e);
  }
};

/// Computes the loads of the listed near pairs, one group of threads per pair.
template <unsigned kFeatures> struct NearPairForces {
  static constexpr double kNanoseconds = GrainPartForces<kFeatures>::kNanoseconds;
  GrainPartForces<kFeatures> forces;
  const std::uint32_t *near, *count;
  std::uint32_t groups;
  template <class Group> GROUSER_HD void operator()(int first, const Group& group) const {
    if (forces.calledOff()) return;
    for (std::uint32_t k = static_cast<std::uint32_t>(first); k < *count; k += groups)
      forces(static_cast<int>(near[k]), group);
  }
};

} // namespace grouser::contact
