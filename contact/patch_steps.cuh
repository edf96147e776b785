// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/algorithms.hpp"
#include "contact/part_motion.hpp"
#include "contact/patch_buffers.hpp"
#include "contact/surface_sample_kernels.cuh"

namespace grouser::contact {

/// Lists the samples of every pair that are within `margin` of touching the target.
template <class Target>
void listSamples(PatchBuffers& buffers, const Target& target, const base::Array<PartMotion>& motion, double margin) {
  base::forEach(buffers.exec, "mark near pairs", static_cast<std::int64_t>(buffers.pairs),
                MarkNearPairs<Target>{target, motion.data(), margin, buffers.near.data()});
  ListSamples<Target> list{target, buffers.sample.data(), buffers.chunks.data(), motion.data(), buffers.near.data(),
                           margin, buffers.count.data(),  buffers.first.data(),  nullptr,       nullptr};
  const auto chunks = static_cast<std::int64_t>(buffers.chunks.size());
  base::forEach(buffers.exec, "count samples", chunks, list);
  buffers.entries =
      base::exclusiveScan(buffers.exec, buffers.count.data(), buffers.first.data(), buffers.chunks.size());
  buffers.entry.resize(buffers.entries);
  buffers.gap.resize(buffers.entries);
  list.entry = buffers.entry.data(), list.gap = buffers.gap.data();
  if (buffers.entries) base::forEach(buffers.exec, "list samples", chunks, list);
}

/// Computes the pressure on every listed sample, then the friction of every patch. Clear the sums before.
/// `travelled`: device pointer to the upper bound of the relative motion of any pair since the samples were listed [m].
/// `off`: device pointer, may be null; nonzero cancels the work.
template <class Target> void computePatches(const base::Exec& exec, PatchBuffers& buffers, const Target& target,
                                            const PatchQuanta& quanta, double timeStep, const double* travelled,
                                            const base::Array<PartMotion>& motion, PartLoad* loads,
                                            const std::uint32_t* off) {
  base::forEachGroup<8>(exec, "pressure of samples", static_cast<std::int64_t>(buffers.entries),
                        SamplePressure<Target>{target, buffers.sample.data(), quanta, motion.data(),
                                               buffers.entry.data(), buffers.gap.data(), travelled, buffers.sums.data(),
                                               loads, timeStep, off});
  base::forEach(exec, "friction of patches", static_cast<std::int64_t>(buffers.sums.size()),
                PatchFriction<Target>{target, quanta, motion.data(), buffers.sums.data(), buffers.states.data(), loads,
                                      timeStep, off});
}

} // namespace grouser::contact
