// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/ground_contacts.hpp"

#include "contact/patch_steps.cuh"
#include "terrain/surface_contacts.hpp"

namespace grouser::terrain {

GroundContacts::GroundContacts(const base::Exec& exec, const Model& model, const HeightField& ground,
                               const std::vector<const base::SphereSet*>& sets, const std::vector<int>& setOfPart,
                               const std::vector<int>& parts)
    : model_(model), buffers_(exec, sets, setOfPart, parts), parts_(exec, parts) {
  std::vector<double> reach;
  for (const base::SphereSet* set : sets) reach.push_back(contact::enclosingRadius(*set));
  reach_ = base::Array<double>(exec, reach);
  std::vector<int> setOfGroundPart;
  for (const int part : parts) setOfGroundPart.push_back(setOfPart[static_cast<std::size_t>(part)]);
  ground_ = SearchedHeightField(exec, ground, widestSample(sets, setOfGroundPart) + model.margin);
}

GroundContacts::Target GroundContacts::target() const {
  return {parts_.data(), buffers_.setOfPart.data(),      reach_.data(), ground_.view(),
          model_.law,    static_cast<int>(parts_.size())};
}

void GroundContacts::refresh(const base::Array<contact::PartMotion>& motion) {
  contact::listSamples(buffers_, target(), motion, model_.margin);
}

void GroundContacts::compute(const base::Array<contact::PartMotion>& motion, const double* travelled,
                             contact::PartLoad* loads) {
  buffers_.sums.zero();
  contact::computePatches(buffers_.exec, buffers_, target(), model_.quanta, model_.timeStep, travelled, motion, loads,
                          nullptr);
}

} // namespace grouser::terrain
