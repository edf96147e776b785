// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/grain_part_model.hpp"

#include "contact/strongest_force.hpp"

#include <algorithm>

namespace grouser::coupling {

contact::GrainPartModel grainPartModel(const GrainsSetup& setup, const terrain::Grains& grains, double margin) {
  const terrain::GrainModel& bed = grains.model();
  contact::GrainPartModel model;
  model.radius = bed.radius, model.mass = bed.mass, model.timeStep = bed.timeStep;
  // A listed grain may move by a whole skin: from half a skin on one side of its reference to half on the other.
  model.margin = bed.skin * bed.radius + margin;
  const terrain::GrainConstants& constants = grains.system().constants;
  model.gap = static_cast<double>(constants.marginUnits) * constants.scale.unit; // 0 with penalty contacts
  model.law = setup.partLaws.laws.front();
  model.manyRadii = setup.manyKinds;
  model.scale = grains.scale();
  double pressed = 0;
  for (const contact::ContactLaw& law : setup.partLaws.laws)
    pressed = std::max(pressed, contact::strongestForce(law, bed.radius, contact::kForcePress));
  // Impulses are summed over the whole run in these quanta, with room for 2^27 steps of a contact at maximum force.
  model.force = base::fixedPointFor(pressed, 36);
  model.torque = base::fixedPointFor(pressed * contact::leverScale(bed.radius), 36);
  model.energy = base::fixedPointFor(pressed * bed.radius, 36);
  return model;
}

} // namespace grouser::coupling
