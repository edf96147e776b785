// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_model.hpp"

#include "runs/setup/laws.hpp"
#include "runs/setup/periodic_boundaries.hpp"

#include <algorithm>

namespace grouser::setup {

terrain::GrainModel grainModel(const scene::Scene& scene, const GrainKinds& kinds, double timeStep,
                               const Surroundings& surroundings, terrain::Boundaries& boundaries) {
  const std::string& first = kinds.material.front();
  terrain::GrainModel model;
  model.radius = kinds.largest, model.smallestRadius = kinds.smallest;
  double density = 0;
  for (const std::string& name : kinds.material) density = std::max(density, scene.material(name).density);
  model.mass = sphereMass(density, kinds.largest);
  model.timeStep = timeStep;
  model.gravity = scene.run.gravity;
  model.skin = scene.run.skin;
  model.maxOverlap = scene.run.maxOverlap;
  model.precision = scene.run.precision;

  // Of one mass, damping is a constant; of many it follows from each contact's.
  const auto mass = [&](double share) { return kinds.many() ? std::nullopt : std::optional(share * model.mass); };
  model.law = pairLaw(scene, first, first, mass(0.5));
  for (const Surroundings::Wall& w : surroundings.walls)
    boundaries.walls.push_back({w.normal, w.offset, pairLaw(scene, first, w.material, mass(1))});
  boundaries.floor = surroundings.floor;
  boundaries.periodic = periodicBoundaries(scene);
  if (surroundings.floor) model.floorLaw = pairLaw(scene, first, surroundings.floorMaterial, mass(1));
  for (const SceneSurface& s : surroundings.surfaces)
    if (!s.mesh)
      boundaries.surfaces.push_back({s.geometry, pairLaw(scene, first, s.section.material, mass(1)), startingPose(s)});
  if (!kinds.manyMaterials()) return model;

  terrain::GrainMaterials& many = model.materials;
  for (const std::string& a : kinds.material) {
    many.density.push_back(scene.material(a).density);
    for (const std::string& b : kinds.material)
      many.grains.push_back(pairLaw(scene, std::min(a, b), std::max(a, b), std::nullopt));
  }
  for (const Surroundings::Wall& w : surroundings.walls)
    for (const std::string& a : kinds.material) many.boundaries.push_back(pairLaw(scene, a, w.material, std::nullopt));
  if (surroundings.floor)
    for (const std::string& a : kinds.material)
      many.boundaries.push_back(pairLaw(scene, a, surroundings.floorMaterial, std::nullopt));
  for (const SceneSurface& s : surroundings.surfaces)
    if (!s.mesh)
      for (const std::string& a : kinds.material)
        many.boundaries.push_back(pairLaw(scene, a, s.section.material, std::nullopt));
  return model;
}

} // namespace grouser::setup
