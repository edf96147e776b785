// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grain_laws.hpp"

#include "base/math.hpp"
#include "contact/strongest_force.hpp"
#include "terrain/grain_kernel_data.cuh"

namespace grouser::terrain {

namespace {

template <class Real> base::Array<contact::BasicLaw<Real>>
onDevice(const base::Exec& exec, const std::vector<contact::ContactLaw>& laws, double radius) {
  std::vector<contact::BasicLaw<Real>> out;
  for (const contact::ContactLaw& law : laws) out.push_back(contact::scaledFor(law, radius).template as<Real>());
  return {exec, out};
}

} // namespace

GrainLaws::GrainLaws(const base::Exec& exec, const GrainConstants& c,
                     const std::vector<contact::ContactLaw>& boundaries) {
  const GrainModel& model = c.model;
  if (model.precision == Precision::single)
    single_ = {onDevice<float>(exec, model.materials.grains, model.radius),
               onDevice<float>(exec, boundaries, model.radius)};
  else
    double_ = {onDevice<double>(exec, model.materials.grains, model.radius),
               onDevice<double>(exec, boundaries, model.radius)};
  std::vector<double> massPerCube;
  for (const double density : model.materials.density) massPerCube.push_back(density * (4.0 / 3 * base::kPi));
  if (massPerCube.empty()) massPerCube.push_back(model.mass / (model.radius * model.radius * model.radius));
  first_ = massPerCube.front();
  massPerCube_ = base::Array<double>(exec, massPerCube);
}

void GrainLaws::replacePairs(const base::Exec& exec, const GrainConstants& c) {
  if (c.model.precision == Precision::single)
    single_.pairs = onDevice<float>(exec, c.model.materials.grains, c.model.radius);
  else
    double_.pairs = onDevice<double>(exec, c.model.materials.grains, c.model.radius);
}

template <class Real> ForceData<Real> GrainLaws::forceData(const GrainConstants& c) const {
  const auto real = [](double value) { return static_cast<Real>(value); };
  const GrainModel& m = c.model;
  const Laws<Real>& l = laws<Real>();
  const contact::BasicLaw<Real> law = contact::scaledFor(m.law, m.radius).as<Real>();
  return {real(m.radius),   real(c.scale.unit),
          real(m.timeStep), real(0.5 * m.mass),
          real(m.mass),     real(static_cast<double>(c.diameterUnits)),
          real(first_),     law,
          l.pairs.data(),   l.boundaries.data(),
          nullptr};
}
template ForceData<float> GrainLaws::forceData(const GrainConstants&) const;
template ForceData<double> GrainLaws::forceData(const GrainConstants&) const;

void GrainLaws::describe(GrainKernelData& d) const {
  d.materials = static_cast<int>(massPerCube_.size()), d.massPerCube = massPerCube_.data();
}

} // namespace grouser::terrain
