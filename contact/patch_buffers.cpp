// SPDX-License-Identifier: BSD-3-Clause
#include "contact/patch_buffers.hpp"

#include <algorithm>

namespace grouser::contact {

PatchBuffers::PatchBuffers(const base::Exec& e, const std::vector<const base::SphereSet*>& sets,
                           const std::vector<int>& setOf, const std::vector<int>& sampledParts)
    : exec(e), pairs(sampledParts.size()), setOfPart(e, setOf), near(e, pairs), entry(e), gap(e),
      sums(e, pairs * kClusters), states(e, pairs * kClusters) {
  constexpr std::uint32_t kSamplesPerChunk = 8;
  std::vector<SurfaceSample> all;
  std::vector<std::uint32_t> start{0};
  for (const base::SphereSet* set : sets) {
    const std::vector<SurfaceSample> samples = surfaceSamplesOf(*set);
    all.insert(all.end(), samples.begin(), samples.end());
    start.push_back(static_cast<std::uint32_t>(all.size()));
  }
  std::vector<SampleChunk> list;
  for (std::uint32_t p = 0; p < sampledParts.size(); ++p) {
    const auto set = static_cast<std::size_t>(setOf[static_cast<std::size_t>(sampledParts[p])]);
    for (std::uint32_t k = start[set]; k < start[set + 1]; k += kSamplesPerChunk)
      list.push_back({p, k, std::min(k + kSamplesPerChunk, start[set + 1])});
  }
  sample = base::Array<SurfaceSample>(e, all);
  chunks = base::Array<SampleChunk>(e, list);
  count = base::Array<std::uint32_t>(e, list.size());
  first = base::Array<std::uint32_t>(e, list.size());
}

PatchBuffers::Ledger PatchBuffers::ledger(const PatchQuanta& quanta) const {
  Ledger ledger;
  std::int64_t elastic = 0;
  for (const PatchSums& s : sums.toHost()) {
    elastic += s.elastic;
    ledger.patches += s.weight > 0;
  }
  ledger.elastic = quanta.energy.value(elastic);
  for (const PatchState& s : states.toHost()) ledger.dissipated += s.dissipated;
  return ledger;
}

} // namespace grouser::contact
