// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/simulation_setup.hpp"

#include "runs/setup/placement.hpp"
#include "runs/setup/restitution_check.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/setup/time_scales.hpp"

namespace grouser::setup {

namespace {

SimulationSetup compiled(const scene::Scene& scene, int ranks, SizeChecks sizes) {
  SimulationSetup setup;
  checkRestitutions(scene);
  // Before the step: what does not fit its mesh may ask for a wrong one.
  if (scene.vehicle) checkParts(scene);
  setup.timeStep = chooseTimeStep(scene);
  setup.gravity = scene.run.gravity;
  setup.ground = groundSetup(scene, setup.timeStep, ranks, sizes);
  if (scene.vehicle) {
    setup.vehicle = vehicleSetup(scene);
    setup.vehicle->largestTurn = largestTurn(scene.run);
    if (setup.ground.grains && !setup.vehicle->soilMeetsShoesAlone)
      setup.vehicle->thickestStone = 2 * setup.ground.grains->model.radius;
  }
  if (!scene.mechanism.empty()) setup.mechanism = mechanismSetup(scene);
  setup.run = {scene.run.duration, scene.run.outputInterval, scene.run.frameInterval, scene.run.checkpointInterval};
  const scene::Output& o = scene.output;
  setup.output = {o.record,       o.frames,       o.contactForces, o.grainsCsv,   o.shoeForces,
                  o.gearContacts, o.finalSurface, o.picture,       o.pictureWidth};
  setup.planes = drawnPlanes(scene);
  return setup;
}

} // namespace

SimulationSetup simulationSetup(const scene::Scene& scene, int ranks) {
  SimulationSetup setup = compiled(scene, ranks, SizeChecks::due);
  setup.provenance = provenanceOf(scene);
  return setup;
}

SimulationSetup simulationSetup(const scene::Scene& scene, const Provenance& provenance, int ranks) {
  SimulationSetup setup = compiled(scene, ranks, SizeChecks::passed);
  setup.provenance = provenance;
  return setup;
}

} // namespace grouser::setup
