// SPDX-License-Identifier: BSD-3-Clause
#include "runs/bed.hpp"

#include "base/error.hpp"
#include "contact/restitution.hpp"
#include "runs/laws.hpp"
#include "runs/mechanism.hpp"
#include "runs/plan.hpp"
#include "runs/sources.hpp"
#include "terrain/heightmap.hpp"
#include "terrain/layers.hpp"
#include "vehicle/spec.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <unistd.h>

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

/// Throws before any memory is taken when the bed cannot fit into this machine.
void checkBedSize(const Scene& scene, const terrain::LayerOptions& options) {
  constexpr double kBytes = 900;
  const Terrain& t = *scene.terrain;
  const double spacing = options.spacingInRadii * options.radius;
  const double layers = options.layers > 0 ? options.layers : std::max(1.0, options.depth / spacing);
  const double grains = t.size[0] * t.size[1] / (spacing * spacing) * layers;
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (grains * kBytes > memory || grains > 4e9)
    throw base::InputError(fmt::format(
        "{}: terrain.grain_radius = {:g} [m] makes about {:.3g} grains, {:.3g} GiB; this machine has {:.3g} "
        "GiB: use larger grains, fewer layers or a smaller terrain.size",
        scene.file.string(), options.radius, grains, grains * kBytes / 1073741824.0, memory / 1073741824.0));
}

terrain::PartitionOptions partitionOf(const Scene& scene, const base::Comm& comm) {
  terrain::PartitionOptions partition;
  partition.comm = comm;
  partition.rebalance = scene.parallel.rebalance;
  partition.cuts = {scene.parallel.cutsX, scene.parallel.cutsY, scene.parallel.cutsZ};
  if (const auto& n = scene.parallel.subdomains)
    partition.subdomains = {static_cast<int>(n->x), static_cast<int>(n->y), static_cast<int>(n->z)};
  return partition;
}

void layBed(const Scene& scene, const base::Exec& exec, double timeStep, const base::Comm& comm, Ground& ground) {
  const Terrain& t = *scene.terrain;
  const terrain::LayerOptions options = layerOptions(scene);
  checkBedSize(scene, options);
  const terrain::BedPlan plan = terrain::planBed(*ground.surface, options);
  const terrain::GrainModel bare = grainModel(scene, t.material, options.radius, timeStep);
  const std::string& groundMaterial = t.groundMaterial.empty() ? t.material : t.groundMaterial;
  const contact::ContactLaw wallLaw = pairLaw(scene, t.material, groundMaterial, bare.mass);
  terrain::GrainModel model = bare;
  model.floorLaw = wallLaw;

  terrain::Boundaries boundaries;
  ground.rigid = plan.floor;
  boundaries.floor = plan.floor;
  ground.walls = plan.walls;
  ground.layers = plan.layers;
  if (t.walls) {
    boundaries.walls.push_back({{1, 0, 0}, plan.walls.xMin, wallLaw});
    boundaries.walls.push_back({{-1, 0, 0}, -plan.walls.xMax, wallLaw});
    boundaries.walls.push_back({{0, 1, 0}, plan.walls.yMin, wallLaw});
    boundaries.walls.push_back({{0, -1, 0}, -plan.walls.yMax, wallLaw});
  }
  addPlanes(scene, t.material, model.mass, boundaries);
  std::vector<terrain::GrainStart> start;
  for (const terrain::Seed& seed : terrain::layGrains(*ground.surface, options)) start.push_back({seed.centre, {}, {}});
  ground.grains =
      std::make_unique<terrain::Grains>(exec, model, std::move(boundaries), start, partitionOf(scene, comm));
}

/// Throws when grains start deeper in each other or in a plane than a run allows.
void checkStartingOverlaps(const Scene& scene) {
  const auto& grains = scene.grains;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const double most = scene.run.maxOverlap * grains[i].radius;
    const auto refuse = [&](double overlap, const std::string& what) {
      if (overlap > most)
        throw base::InputError(
            fmt::format("{}: grain.{}.position: the grain overlaps {} by {:.3g} m, more than run.max_overlap = {:g} "
                        "of its radius; move it",
                        scene.file.string(), i, what, overlap, scene.run.maxOverlap));
    };
    for (std::size_t j = 0; j < i; ++j)
      refuse(grains[i].radius + grains[j].radius - norm(grains[i].position - grains[j].position),
             fmt::format("grain {}", j));
    for (std::size_t k = 0; k < scene.planes.size(); ++k)
      refuse(grains[i].radius -
                 dot(base::normalized(scene.planes[k].normal), grains[i].position - scene.planes[k].point),
             fmt::format("plane {}", k));
  }
}

/// Radius and material of the grains that are not of a bed.
std::pair<double, std::string> kindOfGrains(const Scene& scene) {
  if (!scene.grains.empty()) return {scene.grains.front().radius, scene.grains.front().material};
  return {scene.sources.front().radius, scene.sources.front().material};
}

void requireKind(const Scene& scene, const char* section, double radius, const std::string& material, double ofAll,
                 const std::string& materialOfAll) {
  if (radius == ofAll && material == materialOfAll) return;
  throw base::InputError(fmt::format("{}: [[{}]]: radius {} m of '{}' beside {} m of '{}'; all grains of a scene "
                                     "have one radius and one material so far",
                                     scene.file.string(), section, radius, material, ofAll, materialOfAll));
}

void placeSingleGrains(const Scene& scene, const base::Exec& exec, double timeStep, const base::Comm& comm,
                       Ground& ground) {
  const auto [radius, material] = kindOfGrains(scene);
  std::vector<terrain::GrainStart> start;
  for (const Grain& g : scene.grains) {
    requireKind(scene, "grain", g.radius, g.material, radius, material);
    start.push_back({g.position, g.velocity, g.spin});
  }
  checkStartingOverlaps(scene);
  terrain::GrainModel model = grainModel(scene, material, radius, timeStep);
  terrain::Boundaries boundaries;
  addPlanes(scene, material, model.mass, boundaries);
  if (ground.rigid) {
    boundaries.floor = ground.rigid;
    model.floorLaw = pairLaw(scene, material, scene.terrain->material, model.mass);
  }
  ground.grains =
      std::make_unique<terrain::Grains>(exec, model, std::move(boundaries), start, partitionOf(scene, comm));
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

namespace {

/// Keeps the smallest stable step and what it belongs to.
struct StepLimit {
  double step = std::numeric_limits<double>::infinity();
  std::string what;

  void consider(double omega, double zeta, const std::string& name) {
    const double limit = contact::stableStep(omega, zeta);
    if (limit < step) step = limit, what = name;
  }
  /// A grain of `mass` in `count` contacts of one law at once; tangential springs act on 7/2 of the inverse mass.
  void considerGrain(const contact::ContactLaw& law, double mass, double count, const std::string& name) {
    const double normal = count * law.stiffness / mass;
    const double tangential = law.friction > 0 ? 3.5 * 0.5 * count * law.tangentialStiffness / mass : 0;
    const double omega2 = std::max(normal, tangential);
    consider(std::sqrt(omega2), 0.5 * law.damping / std::sqrt(omega2 * 2 / count), name);
  }
};

StepLimit grainStepLimit(const Scene& scene) {
  StepLimit limit;
  const auto everyContact = [&](const std::string& material, double radius) {
    const double mass = sphereMass(scene.material(material).density, radius);
    // Twelve neighbours: omega^2 <= 8 k / m (Gershgorin). Between two heavy bodies: 2 k / m.
    limit.considerGrain(pairLaw(scene, material, material, 0.5 * mass), mass, 8,
                        "grain on grain of '" + material + "'");
    const auto against = [&](const std::string& other, const std::string& name) {
      limit.considerGrain(pairLaw(scene, material, other.empty() ? material : other, mass), mass, 2, name);
    };
    for (const Plane& plane : scene.planes) against(plane.material, "grain on a plane of '" + plane.material + "'");
    if (scene.terrain) against(scene.terrain->groundMaterial, "grain on the floor");
    if (scene.vehicle) against(scene.vehicle->material, "grain on the vehicle");
  };
  for (const Grain& g : scene.grains) everyContact(g.material, g.radius);
  for (const Source& s : scene.sources) everyContact(s.material, s.radius);
  if (scene.terrain && scene.terrain->granular()) everyContact(scene.terrain->material, *scene.terrain->grainRadius);
  return limit;
}

} // namespace

double stableTimeStep(const Scene& scene) {
  StepLimit limit = grainStepLimit(scene);
  if (scene.vehicle) {
    // A shoe that lies on its whole pad: the stiffest that the foundation can be.
    const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(scene.vehicle->spec);
    const double area = 4 * spec.shoe.halfLength * spec.shoe.padHalfWidth;
    const double omega = std::sqrt(spec.contact.foundationModulus * area / spec.shoe.mass);
    limit.consider(omega, 0.5 * omega * spec.contact.relaxationTime, "shoe on rigid ground or wheel");
  }
  return limit.step;
}

double chooseTimeStep(const Scene& scene) {
  if (!scene.mechanism.empty()) return scene.run.timeStep ? *scene.run.timeStep : mechanismTimeStep(scene);
  const double contact = shortestContact(scene), limit = stableTimeStep(scene);
  const double automatic = std::min(contact > 0 ? contact / kStepsPerContact : kVehicleTimeStep, 0.5 * limit);
  if (!scene.run.timeStep) return automatic;
  if (*scene.run.timeStep > limit)
    throw base::InputError(
        fmt::format("{}: run.time_step = {:g} s is above {:.3g} s, where the stiffest contact of the scene becomes "
                    "unstable; choose {:.3g} s or less (\"auto\": {:.3g} s), or lower its stiffness",
                    scene.file.string(), *scene.run.timeStep, limit, limit, automatic));
  return *scene.run.timeStep;
}

Ground buildGround(const Scene& scene, const base::Exec& exec, double timeStep, const base::Comm& comm) {
  Ground ground;
  if (scene.terrain) {
    ground.surface = readSurface(*scene.terrain);
    if (scene.terrain->granular())
      layBed(scene, exec, timeStep, comm, ground);
    else
      ground.rigid = ground.surface;
  }
  checkSources(scene);
  if (!scene.grains.empty() || (!scene.sources.empty() && !ground.grains)) {
    if (ground.grains)
      throw base::InputError(scene.file.string() +
                             ": [[grain]] and a granular [terrain] in one scene; use one of them");
    if (scene.vehicle && scene.terrain)
      throw base::InputError(scene.file.string() +
                             ": [[grain]] beside a [vehicle] on rigid [terrain] is not possible so far; use "
                             "a granular terrain, or leave the grains out");
    placeSingleGrains(scene, exec, timeStep, comm, ground);
  }
  if (ground.grains) {
    const bool bed = scene.terrain && scene.terrain->granular();
    const auto kind = bed ? std::pair(*scene.terrain->grainRadius, scene.terrain->material) : kindOfGrains(scene);
    for (const Source& s : scene.sources) requireKind(scene, "source", s.radius, s.material, kind.first, kind.second);
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
  const double layers = ground.layers;
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

void keepSurface(Ground& ground, const base::Exec& exec) {
  ground.undisturbed = std::make_shared<terrain::BedSurface>(exec, *ground.grains, ground.rigid->view(), *ground.walls);
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
