// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/surface_contacts.hpp"

#include "contact/patch_steps.cuh"

#include <algorithm>

namespace grouser::terrain {

namespace {

std::vector<int> partsOf(const std::vector<SurfaceContacts::Pair>& pairs) {
  std::vector<int> parts;
  for (const SurfaceContacts::Pair& pair : pairs) parts.push_back(pair.part);
  return parts;
}

} // namespace

double widestSample(const std::vector<const base::SphereSet*>& sets, const std::vector<int>& setOfPart) {
  double widest = 0;
  for (const int set : setOfPart)
    for (const base::SetSphere& s : sets[static_cast<std::size_t>(set)]->spheres) widest = std::max(widest, s.radius);
  return widest;
}

SurfaceContacts::SurfaceContacts(const base::Exec& exec, const Model& model,
                                 const std::vector<const base::SphereSet*>& sets, const std::vector<int>& setOfPart,
                                 const std::vector<Surface>& surfaces, const std::vector<Pair>& pairs,
                                 const HeightField* field)
    : model_(model), buffers_(exec, sets, setOfPart, partsOf(pairs)), pairs_(exec, pairs), surfaces_(exec, surfaces) {
  std::vector<bool> isTarget(sets.size());
  for (const Surface& s : surfaces)
    if (s.kind == Surface::Kind::mesh) isTarget[static_cast<std::size_t>(s.set)] = true;
  const double widest = widestSample(sets, setOfPart);
  std::vector<contact::SurfaceGridView> views;
  std::vector<double> reach;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    const double edge = std::max(0.004, 0.75 * sets[k]->spacing);
    grids_.push_back(isTarget[k] ? contact::SurfaceGrid(exec, *sets[k], widest + model.margin, edge)
                                 : contact::SurfaceGrid());
    views.push_back(grids_.back().view());
    reach.push_back(contact::enclosingRadius(*sets[k]));
  }
  gridViews_ = base::Array<contact::SurfaceGridView>(exec, views);
  reach_ = base::Array<double>(exec, reach);
  if (field) field_ = SearchedHeightField(exec, *field, widest + model.margin);
}

SurfaceContacts::Target SurfaceContacts::target() const {
  return {pairs_.data(), surfaces_.data(), gridViews_.data(), buffers_.setOfPart.data(),
          reach_.data(), field_.view(),    model_.law,        static_cast<int>(pairs_.size())};
}

void SurfaceContacts::refresh(const base::Array<contact::PartMotion>& motion) {
  contact::listSamples(buffers_, target(), motion, model_.margin);
}

void SurfaceContacts::compute(const base::Array<contact::PartMotion>& motion, const double* travelled,
                              contact::PartLoad* loads) {
  buffers_.sums.zero();
  contact::computePatches(buffers_.exec, buffers_, target(), model_.quanta, model_.timeStep, travelled, motion, loads,
                          nullptr);
}

} // namespace grouser::terrain
