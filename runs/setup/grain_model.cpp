// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_model.hpp"

#include "base/sphere.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/laws.hpp"
#include "runs/setup/periodic_boundaries.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace grouser::setup {

using base::Vec3d;

Surroundings surroundingsOf(const scene::Scene& scene, const std::optional<terrain::HeightField>& floor,
                            const terrain::Rectangle& bedWalls) {
  Surroundings around;
  around.floor = floor;
  if (scene.terrain && scene.terrain->granular()) {
    const std::string& material = scene.terrain->groundMaterial;
    const auto add = [&](const Vec3d& normal, double offset) {
      around.walls.push_back({normal, offset, material, "a wall of the terrain", scene.terrain->wallFriction});
    };
    const terrain::Rectangle& w = bedWalls;
    around.floorMaterial = material;
    if (scene.terrain->walls && !scene.run.periodic[0]) add({1, 0, 0}, w.xMin), add({-1, 0, 0}, -w.xMax);
    if (scene.terrain->walls && !scene.run.periodic[1]) add({0, 1, 0}, w.yMin), add({0, -1, 0}, -w.yMax);
  } else if (scene.terrain) {
    around.floorMaterial = scene.terrain->material;
  }
  for (std::size_t k = 0; k < scene.planes.size(); ++k) {
    const scene::Plane& plane = scene.planes[k];
    if (!plane.isWall()) continue;
    const Vec3d normal = base::normalized(plane.normal);
    around.walls.push_back({normal, dot(normal, plane.point), plane.material, fmt::format("plane {}", k)});
  }
  around.surfaces = surfacesOf(scene);
  return around;
}

namespace {

contact::ContactLaw wallLaw(const scene::Scene& scene, const std::string& grain, const Surroundings::Wall& wall,
                            const std::optional<double>& mass) {
  contact::ContactLaw law = pairLaw(scene, grain, wall.material, mass);
  law.friction = wall.friction.value_or(law.friction);
  return law;
}

} // namespace

terrain::GrainModel grainModel(const scene::Scene& scene, const GrainKinds& kinds, double timeStep,
                               const Surroundings& surroundings, terrain::Boundaries& boundaries) {
  const std::string& first = kinds.material.front();
  terrain::GrainModel model;
  model.radius = kinds.largest, model.smallestRadius = kinds.smallest;
  double density = 0;
  for (const std::string& name : kinds.material) density = std::max(density, scene.material(name).density);
  model.mass = base::sphereMass(density, kinds.largest);
  model.timeStep = timeStep;
  model.gravity = scene.run.gravity;
  model.skin = scene.run.skin;
  model.maxOverlap = scene.run.maxOverlap.value_or(model.maxOverlap);
  model.maxSurfaceOverlap = scene.run.maxOverlap.value_or(model.maxSurfaceOverlap);
  model.maxEntryOverlap = scene.run.entryOverlap();
  model.precision = scene.run.precision;
  model.fixedGrains =
      (scene.terrain && scene.terrain->granular() && scene.terrain->floorGrains) ||
      std::any_of(scene.grains.begin(), scene.grains.end(), [](const scene::Grain& g) { return g.fixed; });

  // Of one mass, damping is a constant; of many it follows from each contact's.
  const auto mass = [&](double share) { return kinds.many() ? std::nullopt : std::optional(share * model.mass); };
  model.law = pairLaw(scene, first, first, mass(0.5));
  for (const Surroundings::Wall& w : surroundings.walls)
    boundaries.walls.push_back({w.normal, w.offset, wallLaw(scene, first, w, mass(1))});
  boundaries.floor = surroundings.floor;
  boundaries.periodic = periodicBoundaries(scene);
  if (surroundings.floor) model.floorLaw = pairLaw(scene, first, surroundings.floorMaterial, mass(1));
  for (const SceneSurface& s : surroundings.surfaces)
    if (!s.mesh)
      boundaries.surfaces.push_back(
          {s.geometry, pairLaw(scene, first, s.section.material, mass(1)), coupling::startingPose(s)});
  if (!kinds.manyMaterials()) return model;

  terrain::GrainMaterials& many = model.materials;
  for (const std::string& a : kinds.material) {
    many.density.push_back(scene.material(a).density);
    for (const std::string& b : kinds.material)
      many.grains.push_back(pairLaw(scene, std::min(a, b), std::max(a, b), std::nullopt));
  }
  for (const Surroundings::Wall& w : surroundings.walls)
    for (const std::string& a : kinds.material) many.boundaries.push_back(wallLaw(scene, a, w, std::nullopt));
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
