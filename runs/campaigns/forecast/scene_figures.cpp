// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/forecast/scene_figures.hpp"

#include "base/math.hpp"
#include "coupling/body_shape.hpp"
#include "coupling/mesh_contacts.hpp"
#include "coupling/vehicle_parts.hpp"
#include "runs/setup/bed_alone.hpp"
#include "runs/setup/contact_pairs.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/obstacles.hpp"
#include "runs/setup/placement.hpp"
#include "runs/setup/scene_surfaces.hpp"
#include "runs/setup/vehicle_setup.hpp"
#include "vehicle/assembly.hpp"
#include "vehicle/spec_file.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::forecast {

double sampleGrains(const scene::Scene& scene, double timeStep) {
  const scene::Scene bed = setup::isPutOnBed(scene) ? setup::sceneOfBed(scene) : scene;
  const coupling::GroundSetup ground = setup::groundSetup(bed, timeStep);
  const coupling::BedSetup& laid = *ground.grains->bed;
  const auto& preparation = (laid.tile ? *laid.tile->ground->grains->bed : laid).preparation;
  if (!preparation) return 0;
  const terrain::BedOptions& options = preparation->sample->grains->bed->options;
  const terrain::BedPlan plan = terrain::planBed(*preparation->sample->surface, options);
  return static_cast<double>(plan.grains + terrain::fixedGrains(plan, options));
}

double speedOf(const scene::Scene& scene) {
  double speed = 0;
  if (scene.vehicle) {
    const scene::SpeedTable table = scene.driver.speeds();
    const double pitch = vehicle::readVehicleSpec(scene.vehicle->source()).pitchRadius();
    if (scene.driver.course) speed = std::fabs(scene.driver.course->speed);
    for (const std::vector<double>* side : {&table.left, &table.right})
      for (const double w : *side) speed = std::max(speed, std::fabs(w) * pitch);
  }
  for (const setup::SceneSurface& s : setup::surfacesOf(scene)) {
    double own = s.section.velocity ? norm(*s.section.velocity) : 0;
    if (s.section.spin) own += norm(*s.section.spin) * norm(s.geometry.half);
    if (s.section.amplitude) own += 2 * base::kPi * s.section.frequency.value_or(0) * norm(*s.section.amplitude);
    speed = std::max(speed, own);
  }
  return speed;
}

double keptSpheres(const scene::Scene& scene, double grains, storage::SphereCache kept,
                   std::vector<spheredecomp::CutReport>& cuts) {
  kept.lookUpOnly();
  const coupling::VehicleSetup setup = setup::vehicleSetup(scene);
  const bool rigid = grains == 0;
  try {
    const coupling::VehicleParts parts(vehicle::assemble(setup.spec, {}), setup, base::Comm(), &kept,
                                       rigid ? base::kInfinity : setup::ContactPairs(scene).kinds.smallest,
                                       setup.shapes && rigid && setup::obstaclesOf(scene).empty());
    double spheres = 1; // nonzero if no set is needed
    for (const auto& set : parts.setFigures()) spheres += static_cast<double>(set.spheres);
    cuts = parts.cutReports();
    return spheres;
  } catch (const storage::SphereCache::NotKept&) {
    return 0;
  }
}

bool keptMeshes(const scene::Scene& scene, double grains, double timeStep, storage::SphereCache kept,
                std::vector<spheredecomp::CutReport>& cuts) {
  kept.lookUpOnly();
  std::vector<coupling::SurfaceSetup> obstacles, met;
  std::vector<coupling::PartCut> parts;
  if (grains > 0) {
    met = setup::groundSetup(scene, timeStep).surfaces;
    const double smallest = setup::ContactPairs(scene).kinds.smallest;
    for (const coupling::SurfaceSetup& s : met)
      if (s.mesh) parts.push_back(coupling::meshCut(s, smallest));
  }
  if (scene.vehicle) {
    const double size = coupling::VehicleParts::contactSize(setup::vehicleSpec(scene));
    for (coupling::Obstacle& o : setup::obstaclesOf(scene)) obstacles.push_back(std::move(o.surface));
    for (const coupling::SurfaceSetup& s : obstacles)
      if (s.mesh) parts.push_back(coupling::meshCut(s, size));
  }
  coupling::MechanismSetup mechanism;
  if (scene.mechanism.hasMeshes()) {
    mechanism = setup::mechanismSetup(scene);
    double size = grains > 0 ? setup::ContactPairs(scene).kinds.smallest : base::kInfinity;
    if (scene.vehicle) size = std::min(size, coupling::VehicleParts::contactSize(setup::vehicleSpec(scene)));
    for (coupling::PartCut& cut : coupling::meshCuts(mechanism.shapes, mechanism.model.bodies(), size))
      parts.push_back(std::move(cut));
  }
  try {
    coupling::cutParts(parts, &kept, base::Comm(), &cuts);
    return true;
  } catch (const storage::SphereCache::NotKept&) {
    return false;
  }
}

} // namespace grouser::forecast
