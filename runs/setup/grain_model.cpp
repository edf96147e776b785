// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_model.hpp"

#include "base/sphere.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/complementarity_setup.hpp"
#include "runs/setup/laws.hpp"
#include "runs/setup/periodic_boundaries.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace grouser::setup {

using base::Vec3d;

Surroundings surroundingsOf(const scene::Scene& scene, const ContactPairs& pairs,
                            const std::optional<terrain::HeightField>& floor, const terrain::Rectangle& bedWalls) {
  using Kind = ContactPartner::Kind;
  Surroundings around;
  around.floor = floor, around.surfaces = pairs.surfaces;
  for (const ContactPartner& p : pairs.partners) {
    const auto addWall = [&](const Vec3d& normal, double offset, const std::string& name) {
      around.walls.push_back({normal, offset, p.material, name, p.friction});
    };
    if (p.kind == Kind::bedWalls) {
      const terrain::Rectangle& w = bedWalls;
      if (!scene.run.periodic[0]) addWall({1, 0, 0}, w.xMin, p.name), addWall({-1, 0, 0}, -w.xMax, p.name);
      if (!scene.run.periodic[1]) addWall({0, 1, 0}, w.yMin, p.name), addWall({0, -1, 0}, -w.yMax, p.name);
    } else if (p.kind == Kind::plane) {
      const Vec3d normal = base::normalized(scene.planes[p.number].normal);
      addWall(normal, dot(normal, scene.planes[p.number].point), fmt::format("plane {}", p.number));
    } else if (p.kind == Kind::floor) {
      around.floorMaterial = p.material;
    }
  }
  return around;
}

namespace {

/// A rigid contact partner of grains.
struct Boundary {
  const std::string& material;
  std::optional<double> friction; ///< replaces the friction of the materials [-]
};
/// Walls, floor and surfaces except meshes, in the order of the grains' boundaries.
std::vector<Boundary> boundariesOf(const Surroundings& around) {
  std::vector<Boundary> all;
  for (const Surroundings::Wall& w : around.walls) all.push_back({w.material, w.friction});
  if (around.floor) all.push_back({around.floorMaterial, {}});
  for (const SceneSurface& s : around.surfaces)
    if (!s.mesh) all.push_back({s.section.material, {}});
  return all;
}

contact::ContactLaw boundaryLaw(const scene::Scene& scene, const std::string& grain, const Boundary& boundary,
                                const std::optional<double>& mass) {
  contact::ContactLaw law = pairLaw(scene, grain, boundary.material, mass);
  law.friction = boundary.friction.value_or(law.friction);
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
  model.complementarity = complementarityOptions(scene, timeStep);
  model.maxOverlap = scene.run.maxOverlap.value_or(model.maxOverlap);
  model.maxSurfaceOverlap = scene.run.maxOverlap.value_or(model.maxSurfaceOverlap);
  model.maxEntryOverlap = scene.run.entryOverlap();
  model.precision = scene.run.precision;
  model.fixedGrains =
      (scene.terrain && scene.terrain->granular() && scene.terrain->floorGrains) ||
      std::any_of(scene.grains.begin(), scene.grains.end(), [](const scene::Grain& g) { return g.fixed; });

  // If all grains have one mass, damping is a constant; otherwise it depends on the effective mass of each contact.
  const auto mass = [&](double share) { return kinds.many() ? std::nullopt : std::optional(share * model.mass); };
  model.law = pairLaw(scene, first, first, mass(0.5));
  const std::vector<Boundary> all = boundariesOf(surroundings);
  auto next = all.begin();
  const auto nextLaw = [&] { return boundaryLaw(scene, first, *next++, mass(1)); };
  for (const Surroundings::Wall& w : surroundings.walls) boundaries.walls.push_back({w.normal, w.offset, nextLaw()});
  boundaries.floor = surroundings.floor;
  boundaries.periodic = periodicBoundaries(scene);
  if (surroundings.floor) model.floorLaw = nextLaw();
  for (const SceneSurface& s : surroundings.surfaces)
    if (!s.mesh) boundaries.surfaces.push_back({s.geometry, nextLaw(), coupling::startingPose(s)});
  if (!kinds.manyMaterials()) return model;

  terrain::GrainMaterials& many = model.materials;
  for (const std::string& a : kinds.material) {
    many.density.push_back(scene.material(a).density);
    for (const std::string& b : kinds.material)
      many.grains.push_back(pairLaw(scene, std::min(a, b), std::max(a, b), std::nullopt));
  }
  for (const Boundary& boundary : all)
    for (const std::string& a : kinds.material)
      many.boundaries.push_back(boundaryLaw(scene, a, boundary, std::nullopt));
  return model;
}

} // namespace grouser::setup
