// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_kinds.hpp"

#include "runs/setup/laws.hpp"
#include "runs/setup/periodic_boundaries.hpp"

#include <algorithm>

namespace grouser::setup {

namespace {

void include(GrainKinds& all, const std::string& material, double smallest, double largest) {
  if (!all.any()) all.smallest = smallest, all.largest = largest;
  all.smallest = std::min(all.smallest, smallest), all.largest = std::max(all.largest, largest);
  const int index = all.indexOf(material);
  if (index < 0) {
    all.material.push_back(material);
    all.kinds.push_back({material, smallest, largest});
    return;
  }
  GrainKinds::Kind& kind = all.kinds[static_cast<std::size_t>(index)];
  kind.smallest = std::min(kind.smallest, smallest), kind.largest = std::max(kind.largest, largest);
}

} // namespace

int GrainKinds::indexOf(const std::string& name) const {
  const auto at = std::find(material.begin(), material.end(), name);
  return at == material.end() ? -1 : static_cast<int>(at - material.begin());
}

GrainKinds grainKinds(const scene::Scene& scene) {
  GrainKinds kinds;
  for (const scene::Grain& g : scene.grains) include(kinds, g.material, g.radius, g.radius);
  for (const scene::GrainFill& b : scene.fills) include(kinds, b.material, b.smallestRadius(), b.largestRadius());
  if (scene.terrain && scene.terrain->granular())
    include(kinds, scene.terrain->material, *scene.terrain->grainRadius, *scene.terrain->grainRadius);
  for (const scene::Source& s : scene.sources) include(kinds, s.material, s.radius, s.radius);
  return kinds;
}

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
  boundaries.joined = periodicBoundaries(scene);
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
