// SPDX-License-Identifier: BSD-3-Clause
#include "runs/bed.hpp"

#include "base/error.hpp"
#include "contact/restitution.hpp"
#include "runs/laws.hpp"
#include "runs/plan.hpp"
#include "terrain/heightmap.hpp"
#include "terrain/layers.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace grouser::runs {

using base::Vec3d;

namespace {

terrain::HeightField readSurface(const Terrain& t) {
  terrain::HeightmapPlacement placement;
  placement.sizeX = t.size[0], placement.sizeY = t.size[1];
  placement.black = t.heightRange[0], placement.white = t.heightRange[1];
  return terrain::heightFieldOf(terrain::loadHeightmap(t.heightmap), placement);
}

terrain::GrainModel grainModel(const Scene& scene, const std::string& material, double radius, double timeStep) {
  terrain::GrainModel model;
  model.radius = radius;
  model.mass = sphereMass(scene.material(material).density, radius);
  model.timeStep = timeStep;
  model.gravity = scene.run.gravity;
  model.law = pairLaw(scene, material, material, 0.5 * model.mass);
  model.skin = scene.run.skin;
  model.maxOverlap = scene.run.maxOverlap;
  return model;
}

void addPlanes(const Scene& scene, const std::string& material, double mass, terrain::Boundaries& boundaries) {
  for (const Plane& plane : scene.planes) {
    const Vec3d normal = base::normalized(plane.normal);
    boundaries.walls.push_back({normal, dot(normal, plane.point), pairLaw(scene, material, plane.material, mass)});
  }
}

void layBed(const Scene& scene, const base::Exec& exec, double timeStep, Ground& ground) {
  const Terrain& t = *scene.terrain;
  const terrain::LayerOptions options = layerOptions(scene);
  const terrain::BedPlan plan = terrain::planBed(*ground.surface, options);
  const terrain::GrainModel bare = grainModel(scene, t.material, options.radius, timeStep);
  const std::string& groundMaterial = t.groundMaterial.empty() ? t.material : t.groundMaterial;
  const contact::LinearLaw wallLaw = pairLaw(scene, t.material, groundMaterial, bare.mass);
  terrain::GrainModel model = bare;
  model.floorLaw = wallLaw;

  terrain::Boundaries boundaries;
  ground.rigid = plan.floor;
  boundaries.floor = plan.floor;
  ground.walls = plan.walls;
  if (t.walls) {
    boundaries.walls.push_back({{1, 0, 0}, plan.walls.xMin, wallLaw});
    boundaries.walls.push_back({{-1, 0, 0}, -plan.walls.xMax, wallLaw});
    boundaries.walls.push_back({{0, 1, 0}, plan.walls.yMin, wallLaw});
    boundaries.walls.push_back({{0, -1, 0}, -plan.walls.yMax, wallLaw});
  }
  addPlanes(scene, t.material, model.mass, boundaries);
  std::vector<terrain::GrainStart> start;
  for (const terrain::Seed& seed : terrain::layGrains(*ground.surface, options)) start.push_back({seed.centre, {}, {}});
  ground.grains = std::make_unique<terrain::Grains>(exec, model, std::move(boundaries), start);
}

void placeSingleGrains(const Scene& scene, const base::Exec& exec, double timeStep, Ground& ground) {
  const Grain& first = scene.grains.front();
  std::vector<terrain::GrainStart> start;
  for (const Grain& g : scene.grains) {
    if (g.radius != first.radius || g.material != first.material)
      throw base::InputError(
          fmt::format("{}: [[grain]]: radius {} m of '{}' beside {} m of '{}'; all grains of a scene "
                      "have one radius and one material so far",
                      scene.file.string(), g.radius, g.material, first.radius, first.material));
    start.push_back({g.position, g.velocity, g.spin});
  }
  const terrain::GrainModel model = grainModel(scene, first.material, first.radius, timeStep);
  terrain::Boundaries boundaries;
  addPlanes(scene, first.material, model.mass, boundaries);
  ground.grains = std::make_unique<terrain::Grains>(exec, model, std::move(boundaries), start);
}

} // namespace

terrain::LayerOptions layerOptions(const Scene& scene) {
  const Terrain& t = *scene.terrain;
  terrain::LayerOptions options;
  options.radius = *t.grainRadius, options.layers = t.layers.value_or(0), options.depth = t.depth.value_or(0);
  options.spacingInRadii = t.spacing, options.jitter = t.jitter, options.packing = t.packing;
  options.floor = t.floor == "flat" ? terrain::FloorShape::flat : terrain::FloorShape::follow;
  options.seed = static_cast<std::uint64_t>(scene.run.seed);
  return options;
}

double stableTimeStep(const Scene& scene) {
  double limit = std::numeric_limits<double>::infinity();
  const auto consider = [&](const std::string& material, double radius) {
    const double mass = sphereMass(scene.material(material).density, radius);
    const contact::LinearLaw law = pairLaw(scene, material, material, 0.5 * mass);
    // Twelve neighbours: omega^2 <= 8 k / m (Gershgorin); the dashpot narrows it further.
    const double zeta = 0.5 * law.damping * std::sqrt(0.5 * mass / law.stiffness);
    limit = std::min(limit, contact::stableStep(std::sqrt(8 * law.stiffness / mass), zeta));
  };
  for (const Grain& g : scene.grains) consider(g.material, g.radius);
  if (scene.terrain && scene.terrain->granular()) consider(scene.terrain->material, *scene.terrain->grainRadius);
  return limit;
}

double chooseTimeStep(const Scene& scene) {
  const double contact = shortestContact(scene);
  if (contact <= 0) return scene.run.timeStep.value_or(kVehicleTimeStep);
  if (!scene.run.timeStep) return contact / kStepsPerContact;
  const double limit = stableTimeStep(scene);
  if (*scene.run.timeStep > limit)
    throw base::InputError(
        fmt::format("{}: run.time_step = {:g} s is above {:.3g} s, where the stiffest contacts become "
                    "unstable; choose {:.3g} s or less (\"auto\": {:.3g} s)",
                    scene.file.string(), *scene.run.timeStep, limit, limit, contact / kStepsPerContact));
  return *scene.run.timeStep;
}

Ground buildGround(const Scene& scene, const base::Exec& exec, double timeStep) {
  Ground ground;
  if (scene.terrain) {
    ground.surface = readSurface(*scene.terrain);
    if (scene.terrain->granular())
      layBed(scene, exec, timeStep, ground);
    else
      ground.rigid = ground.surface;
  }
  if (!scene.grains.empty()) {
    if (ground.grains)
      throw base::InputError(scene.file.string() +
                             ": [[grain]] and a granular [terrain] in one scene; use one of them");
    placeSingleGrains(scene, exec, timeStep, ground);
  }
  return ground;
}

SettleReport settle(const Scene& scene, Ground& ground, const SettleProgress& progress) {
  const Terrain& t = *scene.terrain;
  terrain::Grains& grains = *ground.grains;
  const terrain::GrainModel& model = grains.model();
  const double g = norm(model.gravity), dt = model.timeStep;
  const double unit = model.mass * g * model.radius * static_cast<double>(grains.count());
  // Loose layers fall first; nothing is judged before they have landed.
  const double layers = std::max(1, t.layers.value_or(5));
  const double fall = std::sqrt(2 * layers * (t.spacing - 1.6) * model.radius / g);
  const auto checkEvery = std::max<std::int64_t>(1, static_cast<std::int64_t>(0.02 / dt));
  SettleReport report;
  int calm = 0;
  while (report.time < t.settleTimeLimit) {
    for (std::int64_t i = 0; i < checkEvery; ++i) {
      grains.refreshNeighbours();
      grains.step();
    }
    report.steps += checkEvery;
    report.time = static_cast<double>(report.steps) * dt;
    const terrain::GrainLedger ledger = grains.ledger();
    report.agitation = (ledger.kinetic + ledger.rotational) / unit;
    progress(report.time, report.agitation);
    calm = report.agitation < t.settleKineticEnergy ? calm + 1 : 0;
    if (calm >= 5 && report.time > fall) return report;
  }
  throw base::SimulationError(
      fmt::format("the bed has not settled within {:g} s: kinetic energy a grain is {:.3g} of m g "
                  "radius, wanted is {:.3g}; raise terrain.settle_time_limit, lower the material's "
                  "restitution or raise terrain.settle_kinetic_energy",
                  t.settleTimeLimit, report.agitation, t.settleKineticEnergy));
}

void keepSurface(Ground& ground) {
  std::vector<terrain::Seed> seeds;
  const double radius = ground.grains->model().radius;
  for (const Vec3d& p : ground.grains->snapshot().position) seeds.push_back({p, radius});
  ground.undisturbed = std::make_shared<terrain::BedSurface>(seeds, ground.rigid->view(), *ground.walls, 2 * radius);
}

void keepSurface(Ground& ground, const std::vector<double>& heights) {
  ground.undisturbed = std::make_shared<terrain::BedSurface>(*ground.walls, 2 * ground.grains->model().radius, heights);
}

std::function<double(double, double)> surfaceHeight(const Ground& ground) {
  if (const auto bed = ground.undisturbed) return [bed](double x, double y) { return bed->height(x, y); };
  if (!ground.surface) return {};
  const auto field = std::make_shared<terrain::HeightField>(*ground.surface);
  return [field](double x, double y) { return field->height(x, y); };
}

} // namespace grouser::runs
