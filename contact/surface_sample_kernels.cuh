// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/for_each_group.cuh"
#include "contact/part_motion.hpp"
#include "contact/part_surface.hpp"
#include "contact/patch_law.hpp"

/// Kernel bodies of contacts between extended surfaces. Part A is represented by its samples; the other side is a
/// Target: another part's table of discs, or the ground. A patch consists of all touching samples of one pair with
/// normals in one cluster.
///
/// Members required of a Target:
///   int pairs                                   number of pairs
///   int partA(pair), partB(pair)                 indices into the motions; partB < 0: fixed
///   bool near(pair, motion, margin)              true if contact is possible
///   bool findContact(pair, motion, x, radius, group, normal, overlap)   at world point x: normal of B, overlap > 0
///   PatchLaw law(pair)
namespace grouser::contact {

/// Bound of the rounding error of distances in single precision [m].
inline constexpr double kGapSlack = 1e-6;

/// Marks pairs that may be in contact.
template <class Target> struct MarkNearPairs {
  static constexpr double kNanoseconds = 20;
  Target target;
  const PartMotion* motion;
  double margin;
  std::uint32_t* near;
  GROUSER_HD void operator()(int pair) const { near[pair] = target.near(pair, motion, margin) ? 1u : 0u; }
};

/// Counts (if `entry` is null) or lists the samples of one chunk within `margin` of contact, each with its gap: a
/// sample is skipped until the two surfaces have moved by its gap relative to each other.
template <class Target> struct ListSamples {
  static constexpr double kNanoseconds = 60; ///< most chunks belong to distant pairs
  Target target;
  const SurfaceSample* samples;
  const SampleChunk* chunks;
  const PartMotion* motion;
  const std::uint32_t* near;
  double margin;
  std::uint32_t *count, *first;
  std::uint64_t* entry; ///< pair << 32 | sample
  float* gap;           ///< [m], a lower bound

  GROUSER_HD void operator()(int item) const {
    if (entry && count[item] == 0) return; // as counted before
    const SampleChunk chunk = chunks[item];
    const int pair = static_cast<int>(chunk.pair);
    std::uint32_t found = 0;
    if (near[pair]) {
      const PartMotion& a = motion[target.partA(pair)];
      for (std::uint32_t k = chunk.first; k < chunk.last; ++k) {
        const SurfaceSample& sample = samples[k];
        base::Vec3d normal;
        double overlap;
        const base::Vec3d x = a.toWorld(sample.centre.template as<double>());
        if (!target.findContact(pair, motion, x, static_cast<double>(sample.radius) + margin, base::ThreadGroup<1>{0},
                                normal, overlap))
          continue;
        if (entry) {
          entry[first[item] + found] = static_cast<std::uint64_t>(pair) << 32 | k;
          gap[first[item] + found] = static_cast<float>(margin - overlap - kGapSlack);
        }
        ++found;
      }
    }
    if (!entry) count[item] = found;
  }
};

GROUSER_HD void addTo(base::Vec3l& target, const base::Vec3l& value) {
  base::atomicAdd64(&target.x, value.x);
  base::atomicAdd64(&target.y, value.y);
  base::atomicAdd64(&target.z, value.z);
}

/// Applies `force` (quanta) at world point x to A and its exact opposite to B, each about its own centre of mass.
GROUSER_HD void applyToBoth(const PatchQuanta& quanta, const PartMotion* motion, int a, int b, const base::Vec3d& x,
                            const base::Vec3l& force, PartLoad* loads) {
  const base::Vec3d f = quanta.force.value(force);
  addTo(loads[a].force, force);
  addTo(loads[a].torque, quanta.torque.quantise(cross(x - motion[a].centre, f)));
  if (b < 0) return;
  addTo(loads[b].force, -force);
  addTo(loads[b].torque, quanta.torque.quantise(cross(x - motion[b].centre, -f)));
}

/// Computes the pressure on one sample.
template <class Target> struct SamplePressure {
  static constexpr double kNanoseconds = 100;
  Target target;
  const SurfaceSample* samples;
  PatchQuanta quanta;
  const PartMotion* motion;
  const std::uint64_t* entry;
  const float* gap;
  const double* travelled; ///< upper bound of the relative motion of any pair since the samples were listed [m]
  PatchSums* patches;      ///< [pair * kClusters + cluster]
  PartLoad* loads;
  double timeStep;
  const std::uint32_t* off; ///< nonzero: cancelled, see base::Gate; null: never

  template <class Group> GROUSER_HD void operator()(int e, const Group& group) const {
    if (off && *off) return;
    if (static_cast<double>(gap[e]) > *travelled) return;
    const int pair = static_cast<int>(entry[e] >> 32);
    const SurfaceSample sample = samples[entry[e] & 0xFFFFFFFFu];
    const int a = target.partA(pair), b = target.partB(pair);
    const base::Vec3d centre = motion[a].toWorld(sample.centre.template as<double>());
    base::Vec3d normal;
    double overlap;
    if (!target.findContact(pair, motion, centre, static_cast<double>(sample.radius), group, normal, overlap)) return;
    if (group.rank != 0) return; // one thread completes the sample
    const base::Vec3d x = centre - normal * (static_cast<double>(sample.radius) - 0.5 * overlap);
    base::Vec3d relative = motion[a].velocityAt(x);
    if (b >= 0) relative -= motion[b].velocityAt(x);
    const double area = static_cast<double>(sample.area);
    const PointPressure<double> p = pressureAt(target.law(pair), timeStep, area, overlap, dot(relative, normal));
    const base::Vec3l force = quanta.force.quantise(normal * p.size);
    applyToBoth(quanta, motion, a, b, x, force, loads);
    PatchSums& patch = patches[static_cast<std::int64_t>(pair) * kClusters + sample.cluster];
    base::atomicAdd64(&patch.area, quanta.area.quantise(area));
    base::atomicAdd64(&patch.weight, quanta.force.quantise(p.size));
    addTo(patch.place, quanta.moment.quantise((x - motion[a].centre) * p.size));
    addTo(patch.normalForce, force);
    base::atomicAdd64(&patch.elastic, quanta.energy.quantise(p.elastic));
    base::atomicAdd64(&patch.dissipated, quanta.energy.quantise(p.dissipated));
  }
};

/// Computes the friction of one patch, at its centre of pressure.
template <class Target> struct PatchFriction {
  static constexpr double kNanoseconds = 10;
  Target target;
  PatchQuanta quanta;
  const PartMotion* motion;
  PatchSums* patches;
  PatchState* states;
  PartLoad* loads;
  double timeStep;
  const std::uint32_t* off; ///< as in SamplePressure

  GROUSER_HD void operator()(int index) const {
    if (off && *off) return;
    PatchSums& sums = patches[index];
    PatchState& state = states[index];
    if (sums.weight <= 0) {
      endContact(state);
      state.dissipated += quanta.energy.value(sums.dissipated);
      return;
    }
    const int pair = index / kClusters;
    const int a = target.partA(pair), b = target.partB(pair);
    const PatchLaw law = target.law(pair);
    const double weight = quanta.force.value(sums.weight);
    const base::Vec3d normalForce = quanta.force.value(sums.normalForce);
    const double pressing = norm(normalForce);
    double dissipated = quanta.energy.value(sums.dissipated);
    if (law.friction > 0 && pressing > 0) {
      const base::Vec3d x = motion[a].centre + quanta.moment.value(sums.place) * (1 / weight);
      base::Vec3d relative = motion[a].velocityAt(x);
      if (b >= 0) relative -= motion[b].velocityAt(x);
      const PatchSlide slid =
          slide(law, state, normalForce * (1 / pressing), relative, weight, quanta.area.value(sums.area), timeStep);
      dissipated += slid.dissipated;
      base::atomicAdd64(&sums.elastic, quanta.energy.quantise(slid.elastic));
      applyToBoth(quanta, motion, a, b, x, quanta.force.quantise(slid.force), loads);
    }
    state.dissipated += dissipated;
  }
};

} // namespace grouser::contact
