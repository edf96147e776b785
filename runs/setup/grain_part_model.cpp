// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_part_model.hpp"

#include "runs/setup/grain_kinds.hpp"
#include "runs/setup/laws.hpp"

#include <algorithm>

namespace grouser::setup {

GrainPartSetup grainPartModel(const scene::Scene& scene, const terrain::Grains& grains, double timeStep, double margin,
                              const PartLaw& lawOf) {
  const terrain::GrainModel& bed = grains.model();
  const GrainKinds kinds = grainKinds(scene);
  const std::optional<double> mass = kinds.many() ? std::nullopt : std::optional(bed.mass);
  GrainPartSetup setup;
  contact::GrainPartModel& model = setup.model;
  model.radius = bed.radius, model.mass = bed.mass, model.timeStep = timeStep;
  // A grain listed at one end of its half skin may touch at the other.
  model.margin = bed.skin * bed.radius + margin;
  model.law = lawOf(kinds.material.front(), mass);
  model.manyRadii = kinds.many();
  model.scale = grains.scale();
  double pressed = 0;
  for (const std::string& soil : kinds.material) {
    const contact::ContactLaw law = lawOf(soil, mass);
    setup.materials.laws.push_back(law);
    setup.materials.massPerCube.push_back(sphereMass(scene.material(soil).density, 1));
    pressed = std::max(pressed, law.stiffness * bed.radius * (law.hertz ? 0.1 * bed.radius : 1.0));
  }
  // Impulses are summed over the whole run in these quanta: 2^27 steps of a fully pressed contact.
  model.force = base::fixedPointFor(pressed, 36);
  model.torque = base::fixedPointFor(pressed, 36);
  model.energy = base::fixedPointFor(pressed * bed.radius, 36);
  return setup;
}

} // namespace grouser::setup
