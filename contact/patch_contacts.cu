// SPDX-License-Identifier: BSD-3-Clause
#include "contact/patch_contacts.hpp"

#include "contact/patch_steps.cuh"

#include <algorithm>

namespace grouser::contact {

namespace {

std::vector<int> sampledParts(const std::vector<PartPair>& pairs) {
  std::vector<int> parts;
  for (const PartPair& pair : pairs) parts.push_back(pair.a);
  return parts;
}

} // namespace

PartPartContacts::PartPartContacts(const base::Exec& exec, const Model& model,
                                   const std::vector<const base::SphereSet*>& sets, const std::vector<int>& setOfPart,
                                   const std::vector<PartPair>& pairs)
    : model_(model), buffers_(exec, sets, setOfPart, sampledParts(pairs)), pairs_(exec, pairs) {
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
  listSamples(buffers_, target(), motion, model_.margin);
}

void PartPartContacts::compute(const base::Array<PartMotion>& motion, const double* travelled, PartLoad* loads) {
  buffers_.sums.zero();
  computeOnCleared(buffers_.exec, motion, travelled, loads, nullptr);
}

void PartPartContacts::computeOnCleared(const base::Exec& exec, const base::Array<PartMotion>& motion,
                                        const double* travelled, PartLoad* loads, const std::uint32_t* off) {
  computePatches(exec, buffers_, target(), model_.quanta, model_.timeStep, travelled, motion, loads, off);
}

} // namespace grouser::contact
