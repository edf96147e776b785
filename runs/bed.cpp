// SPDX-License-Identifier: BSD-3-Clause
#include "runs/bed.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/grain_kinds.hpp"
#include "runs/grain_memory.hpp"
#include "runs/joined_sides.hpp"
#include "runs/sources.hpp"
#include "runs/step_limit.hpp"
#include "runs/tiled_bed.hpp"
#include "terrain/heightmap.hpp"
#include "terrain/layers.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <tuple>
#include <unistd.h>

namespace grouser::runs {

using base::Vec3d;

terrain::HeightField readSurface(const Terrain& t) {
  terrain::HeightmapPlacement placement;
  placement.sizeX = t.size[0], placement.sizeY = t.size[1];
  placement.black = t.heightRange[0], placement.white = t.heightRange[1];
  return terrain::heightFieldOf(terrain::loadHeightmap(t.heightmap), placement);
}

namespace {

void addPlanesAndSurfaces(const Scene& scene, Surroundings& around) {
  around.surfaces = surfacesOf(scene);
  for (const Plane& plane : scene.planes) {
    if (!plane.isWall()) continue;
    const Vec3d normal = base::normalized(plane.normal);
    around.walls.push_back({normal, dot(normal, plane.point), plane.material});
  }
}

/// Throws before any memory is taken when the bed cannot fit into this machine.
void checkBedSize(const Scene& scene, const terrain::LayerOptions& options) {
  const double bytes = grainMemory(scene).most();
  const Terrain& t = *scene.terrain;
  const double spacing = options.spacingInRadii * options.radius;
  const double layers = options.layers > 0 ? options.layers : std::max(1.0, options.depth / spacing);
  const double grains = t.size[0] * t.size[1] / (spacing * spacing) * layers;
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (grains * bytes > memory || grains > 4e9)
    throw base::InputError(fmt::format(
        "{}: terrain.grain_radius = {:g} [m] makes about {:.3g} grains, {:.3g} GiB; this machine has {:.3g} "
        "GiB: use larger grains, fewer layers or a smaller terrain.size",
        scene.file.string(), options.radius, grains, grains * bytes / 1073741824.0, memory / 1073741824.0));
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
  const GrainKinds kinds = grainKinds(scene);
  const std::string& groundMaterial = t.groundMaterial.empty() ? t.material : t.groundMaterial;
  ground.rigid = plan.floor;
  ground.walls = plan.walls;
  ground.layers = plan.layers;
  Surroundings around;
  around.floor = plan.floor, around.floorMaterial = groundMaterial;
  checkLevelAcross(scene, *ground.surface);
  if (t.walls && !scene.run.periodic[0])
    around.walls = {{{1, 0, 0}, plan.walls.xMin, groundMaterial}, {{-1, 0, 0}, -plan.walls.xMax, groundMaterial}};
  if (t.walls && !scene.run.periodic[1])
    around.walls.insert(around.walls.end(),
                        {{{0, 1, 0}, plan.walls.yMin, groundMaterial}, {{0, -1, 0}, -plan.walls.yMax, groundMaterial}});
  addPlanesAndSurfaces(scene, around);
  terrain::Boundaries boundaries;
  const terrain::GrainModel model = grainModel(scene, kinds, timeStep, around, boundaries);
  std::optional<TiledBed> tiles;
  std::vector<terrain::GrainStart> start;
  // The bed is laid around what stands in it.
  const auto taken = [&](const Vec3d& centre) {
    return std::any_of(around.surfaces.begin(), around.surfaces.end(),
                       [&](const SceneSurface& s) { return startingOverlap(s, centre, options.radius) > 0; });
  };
  if (t.tile) {
    tiles.emplace(scene, *ground.surface, plan, exec, timeStep);
    start = tiles->start(options.radius, kinds.indexOf(t.material));
    ground.layers = 0; // nothing falls
    if (std::any_of(start.begin(), start.end(), [&](const auto& g) { return taken(g.position); }))
      throw base::InputError(fmt::format("{}: terrain.tile copies a settled bed, which a box, cylinder or plane of the "
                                         "scene reaches into; move that, or remove terrain.tile",
                                         scene.file.string()));
  } else {
    for (const terrain::Seed& seed : terrain::layGrains(*ground.surface, options))
      if (!taken(seed.centre)) start.push_back({seed.centre, {}, {}, options.radius, kinds.indexOf(t.material)});
  }
  const std::size_t floor = boundaries.walls.size(); // behind the walls, before the surfaces
  ground.grains =
      std::make_unique<terrain::Grains>(exec, model, std::move(boundaries), start, partitionOf(scene, comm));
  if (tiles) tiles->bringToRest(*ground.grains, floor);
}

/// Cells of one largest diameter along one axis, in a ring between joined sides.
struct CellsAlong {
  double from = 0, width;
  std::int64_t ring = 0; ///< cells between joined sides; 0: walls or nothing
  double period = 0;

  CellsAlong(double diameter, const std::optional<std::array<double, 2>>& joined) : width(diameter) {
    if (!joined) return;
    from = (*joined)[0], period = (*joined)[1] - from;
    ring = std::max<std::int64_t>(1, static_cast<std::int64_t>(period / diameter));
    width = period / static_cast<double>(ring);
  }
  std::int64_t of(double x) const { return wrapped(static_cast<std::int64_t>(std::floor((x - from) / width))); }
  std::int64_t wrapped(std::int64_t k) const { return ring > 0 ? (k % ring + ring) % ring : k; }
  double nearest(double d) const { return ring > 0 ? d - period * std::floor(d / period + 0.5) : d; }
};

/// Throws when grains start deeper in each other, in a plane or in another surface than a run allows.
void checkStartingOverlaps(const Scene& scene, const std::vector<Grain>& grains, double largest) {
  using Cell = std::tuple<std::int64_t, std::int64_t, std::int64_t>;
  const terrain::JoinedSides joined = joinedSides(scene);
  const CellsAlong alongX(2 * largest, joined[0]), alongY(2 * largest, joined[1]), alongZ(2 * largest, {});
  std::map<Cell, std::vector<std::size_t>> cells;
  const std::vector<SceneSurface> surfaces = surfacesOf(scene);
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const Grain& g = grains[i];
    const auto refuseAbove = [&](double overlap, double radius, const char* what, std::size_t which) {
      if (overlap <= scene.run.maxOverlap * radius) return;
      const std::string grain = i < scene.grains.size() ? fmt::format("grain.{}.position: the grain", i)
                                                        : fmt::format("grains: grain {} at ({:g}, {:g}, {:g}) m", i,
                                                                      g.position.x, g.position.y, g.position.z);
      throw base::InputError(fmt::format("{}: {} overlaps {} {} by {:.3g} m, more than run.max_overlap = {:g} "
                                         "of its radius; move it",
                                         scene.file.string(), grain, what, which, overlap, scene.run.maxOverlap));
    };
    const std::int64_t x = alongX.of(g.position.x), y = alongY.of(g.position.y), z = alongZ.of(g.position.z);
    for (std::int64_t k = 0; k < 27; ++k) {
      const auto found = cells.find({alongX.wrapped(x + k / 9 - 1), alongY.wrapped(y + k / 3 % 3 - 1), z + k % 3 - 1});
      if (found == cells.end()) continue;
      for (const std::size_t j : found->second) {
        Vec3d apart = g.position - grains[j].position;
        apart.x = alongX.nearest(apart.x), apart.y = alongY.nearest(apart.y);
        refuseAbove(g.radius + grains[j].radius - norm(apart), std::min(g.radius, grains[j].radius), "grain", j);
      }
    }
    cells[{x, y, z}].push_back(i);
    for (const SceneSurface& s : surfaces)
      refuseAbove(startingOverlap(s, g.position, g.radius), g.radius, s.kind, s.number);
    for (std::size_t k = 0; k < scene.planes.size(); ++k)
      if (scene.planes[k].isWall())
        refuseAbove(g.radius - dot(base::normalized(scene.planes[k].normal), g.position - scene.planes[k].point),
                    g.radius, "plane", k);
  }
}

void placeSingleGrains(const Scene& scene, const base::Exec& exec, double timeStep, const base::Comm& comm,
                       Ground& ground) {
  const GrainKinds kinds = grainKinds(scene);
  const std::vector<Grain> grains = placedGrains(scene);
  checkBetweenSides(scene, grains);
  checkStartingOverlaps(scene, grains, kinds.largest);
  std::vector<terrain::GrainStart> start;
  for (const Grain& g : grains) start.push_back({g.position, g.velocity, g.spin, g.radius, kinds.indexOf(g.material)});
  Surroundings around;
  addPlanesAndSurfaces(scene, around);
  if (ground.rigid) around.floor = ground.rigid, around.floorMaterial = scene.terrain->material;
  terrain::Boundaries boundaries;
  const terrain::GrainModel model = grainModel(scene, kinds, timeStep, around, boundaries);
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
  options.joined = scene.run.periodic;
  return options;
}

Ground buildGround(const Scene& scene, const base::Exec& exec, double timeStep, const base::Comm& comm) {
  Ground ground;
  checkSurfaceSpeeds(scene, timeStep);
  if (scene.terrain) {
    ground.surface = readSurface(*scene.terrain);
    if (scene.terrain->granular())
      layBed(scene, exec, timeStep, comm, ground);
    else
      ground.rigid = ground.surface;
  }
  checkSources(scene);
  const bool single = !scene.grains.empty() || !scene.blocks.empty();
  if (single || (!scene.sources.empty() && !ground.grains)) {
    if (ground.grains)
      throw base::InputError(scene.file.string() +
                             ": [[grain]] and a granular [terrain] in one scene; use one of them");
    if (scene.vehicle && scene.terrain)
      throw base::InputError(scene.file.string() +
                             ": [[grain]] beside a [vehicle] on rigid [terrain] is not possible so far; use "
                             "a granular terrain, or leave the grains out");
    placeSingleGrains(scene, exec, timeStep, comm, ground);
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
  double forceRatio = 0;
  int calm = 0;
  while (report.time < t.settleTimeLimit) {
    for (std::int64_t i = 0; i < checkEvery; ++i) {
      grains.refreshNeighbours();
      grains.step();
    }
    report.steps += checkEvery;
    report.time = static_cast<double>(report.steps) * dt;
    if (t.settleForceRatio) forceRatio = grains.forceRatio(); // before anything else is done with the step
    const terrain::GrainLedger ledger = grains.ledger();
    report.agitation = (ledger.kinetic + ledger.rotational) / unit;
    progress(report.time, report.agitation);
    const bool rests =
        report.agitation < t.settleKineticEnergy && (!t.settleForceRatio || forceRatio < *t.settleForceRatio);
    calm = rests ? calm + 1 : 0;
    if (calm >= 5 && report.time > fall) return report;
  }
  throw base::SimulationError(
      fmt::format("the bed has not settled within {:g} s: kinetic energy a grain is {:.3g} of m g "
                  "radius, wanted is {:.3g}{}; raise terrain.settle_time_limit, lower the material's "
                  "restitution or raise terrain.settle_kinetic_energy{}",
                  t.settleTimeLimit, report.agitation, t.settleKineticEnergy,
                  t.settleForceRatio ? fmt::format(", and the mean resultant force on a grain is {:.3g} of its weight, "
                                                   "wanted is {:.3g}",
                                                   forceRatio, *t.settleForceRatio)
                                     : "",
                  t.settleForceRatio ? " and settle_force_ratio" : ""));
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
