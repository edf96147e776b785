// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/ground_contacts.hpp"

#include "contact/patch_steps.cuh"

namespace grouser::terrain {

GroundContacts::GroundContacts(const base::Exec& exec, const Model& model, const HeightField& ground,
                               const std::vector<const base::SphereSet*>& sets, const std::vector<int>& setOfPart,
                               const std::vector<int>& parts)
    : model_(model), buffers_(exec, sets, setOfPart, parts), parts_(exec, parts), heights_(exec, ground.heights()),
      ground_(ground.view()) {
  std::vector<double> reach;
  for (const base::SphereSet* set : sets) reach.push_back(contact::enclosingRadius(*set));
  reach_ = base::Array<double>(exec, reach);
  ground_.heights = heights_.data();
}

GroundContacts::Target GroundContacts::target() const {
  return {parts_.data(), buffers_.setOfPart.data(),      reach_.data(), ground_,
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
