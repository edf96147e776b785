// SPDX-License-Identifier: BSD-3-Clause
#include "contact/patch_contacts.hpp"

#include "contact/patch_steps.cuh"

#include <algorithm>

namespace grouser::contact {

namespace {

std::vector<int> probedParts(const std::vector<PartPair>& pairs) {
  std::vector<int> parts;
  for (const PartPair& pair : pairs) parts.push_back(pair.a);
  return parts;
}

} // namespace

PatchBuffers::PatchBuffers(const base::Exec& e, const std::vector<const base::SphereSet*>& sets,
                           const std::vector<int>& setOf, const std::vector<int>& probedParts)
    : exec(e), pairs(probedParts.size()), setOfPart(e, setOf), near(e, pairs), entry(e), gap(e),
      sums(e, pairs * kClusters), states(e, pairs * kClusters) {
  constexpr std::uint32_t kProbesPerChunk = 8;
  std::vector<SurfaceSample> all;
  std::vector<std::uint32_t> start{0};
  for (const base::SphereSet* set : sets) {
    const std::vector<SurfaceSample> samples = surfaceSamplesOf(*set);
    all.insert(all.end(), samples.begin(), samples.end());
    start.push_back(static_cast<std::uint32_t>(all.size()));
  }
  std::vector<ProbeChunk> list;
  for (std::uint32_t p = 0; p < probedParts.size(); ++p) {
    const auto set = static_cast<std::size_t>(setOf[static_cast<std::size_t>(probedParts[p])]);
    for (std::uint32_t k = start[set]; k < start[set + 1]; k += kProbesPerChunk)
      list.push_back({p, k, std::min(k + kProbesPerChunk, start[set + 1])});
  }
  sample = base::Array<SurfaceSample>(e, all);
  chunks = base::Array<ProbeChunk>(e, list);
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

PartPartContacts::PartPartContacts(const base::Exec& exec, const Model& model,
                                   const std::vector<const base::SphereSet*>& sets, const std::vector<int>& setOfPart,
                                   const std::vector<PartPair>& pairs)
    : model_(model), buffers_(exec, sets, setOfPart, probedParts(pairs)), pairs_(exec, pairs) {
  std::vector<bool> isTarget(sets.size());
  double widest = 0;
  for (const PartPair& pair : pairs) {
    isTarget[static_cast<std::size_t>(setOfPart[static_cast<std::size_t>(pair.b)])] = true;
    for (const base::SetSphere& s :
         sets[static_cast<std::size_t>(setOfPart[static_cast<std::size_t>(pair.a)])]->spheres)
      widest = std::max(widest, s.radius);
  }
  std::vector<SurfaceGridView> views;
  std::vector<double> reach;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const double edge = std::max(0.004, 0.75 * sets[s]->spacing);
    grids_.push_back(isTarget[s] ? SurfaceGrid(exec, *sets[s], widest + model.margin, edge) : SurfaceGrid());
    views.push_back(grids_.back().view());
    reach.push_back(enclosingRadius(*sets[s]));
  }
  gridViews_ = base::Array<SurfaceGridView>(exec, views);
  reach_ = base::Array<double>(exec, reach);
}

PartPartContacts::Target PartPartContacts::target() const {
  return {pairs_.data(), gridViews_.data(), buffers_.setOfPart.data(),
          reach_.data(), model_.law,        static_cast<int>(pairs_.size())};
}

void PartPartContacts::refresh(const base::Array<PartMotion>& motion) {
  listProbes(buffers_, target(), motion, model_.margin);
}

void PartPartContacts::compute(const base::Array<PartMotion>& motion, const double* travelled, PartLoad* loads) {
  pressAndRub(buffers_, target(), model_.quanta, model_.timeStep, travelled, motion, loads);
}

} // namespace grouser::contact
