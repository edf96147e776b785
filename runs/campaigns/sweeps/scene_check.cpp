// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/scene_check.hpp"

#include "coupling/mechanism.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/complementarity_setup.hpp"
#include "runs/setup/grain_count.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/placement.hpp"
#include "runs/setup/restitution_check.hpp"
#include "runs/setup/size_checks.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/setup/vehicle_surroundings.hpp"

namespace grouser::sweeps {

void checkScene(const scene::Scene& scene, bool sizes) {
  if (sizes) setup::checkFillSizes(scene), setup::checkBedSize(scene);
  setup::checkRestitutions(scene);
  setup::checkComplementarity(scene);
  setup::plannedGrains(scene);
  if (scene.vehicle) {
    setup::placeVehicle(scene, setup::vehicleSpec(scene));
    setup::checkParts(scene);
  }
  const double step = setup::chooseTimeStep(scene);
  setup::checkGround(scene, step);
  if (!scene.mechanism.empty()) const coupling::Mechanism mechanism(setup::contactFreeSetup(scene), step);
}

} // namespace grouser::sweeps
