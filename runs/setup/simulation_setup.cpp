// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/complementarity_setup.hpp"

#include "runs/scene/scene.hpp"
#include "runs/setup/field_checks.hpp"
#include "runs/setup/fluid_setup.hpp"
#include "runs/setup/lattice.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/placement.hpp"
#include "runs/setup/restitution_check.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/setup/time_scales.hpp"
#include "runs/setup/vehicle_setup.hpp"

namespace grouser::setup {

coupling::SimulationSetup simulationSetup(const scene::Scene& scene, int ranks, SizeChecks sizes) {
  coupling::SimulationSetup setup;
  checkRestitutions(scene);
  checkComplementarity(scene);
  // Before the time step is chosen, which requires valid parts.
  if (scene.vehicle) checkParts(scene);
  setup.timeStep = chooseTimeStep(scene);
  setup.gravity = scene.run.gravity;
  setup.ground = groundSetup(scene, setup.timeStep, ranks, sizes);
  checkFields(scene, setup.ground);
  if (scene.vehicle) {
    setup.vehicle = vehicleSetup(scene);
    setup.vehicle->largestTurn = largestTurn(scene.run);
    if (setup.ground.grains && !setup.vehicle->soilTouchesShoesOnly)
      setup.vehicle->thickestStone = 2 * setup.ground.grains->model.radius;
  }
  if (!scene.mechanism.empty()) setup.mechanism = mechanismSetup(scene);
  if (scene.fluid) checkLattice(scene, ranks);
  setup.fluid = fluidSetup(scene, setup.timeStep);
  return setup;
}

} // namespace grouser::setup
