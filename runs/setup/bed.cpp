// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/bed.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/setup/grain_kinds.hpp"
#include "runs/setup/grain_memory.hpp"
#include "runs/setup/lattice.hpp"
#include "runs/setup/periodic_boundaries.hpp"
#include "runs/setup/placement.hpp"
#include "runs/setup/start_checks.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/setup/tiled_bed.hpp"
#include "terrain/heightmap.hpp"
#include "terrain/layers.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <unistd.h>

namespace grouser::setup {

using base::Vec3d;

terrain::HeightField readSurface(const scene::Scene& scene) {
  const scene::Terrain& t = *scene.terrain;
  terrain::HeightmapPlacement placement;
  placement.sizeX = t.size[0], placement.sizeY = t.size[1];
  placement.black = t.heightRange[0], placement.white = t.heightRange[1];
  try {
    return terrain::heightFieldOf(terrain::loadHeightmap(t.heightmap), placement);
  } catch (const base::InputError& error) {
    scene.fail("terrain", "heightmap", fmt::format("is of no use: {}", error.what()));
  }
}

namespace {

/// Walls and floor of the terrain, planes and surfaces, in the order in which grains know them.
Surroundings surroundingsOf(const scene::Scene& scene, const Ground& ground) {
  Surroundings around;
  around.floor = ground.rigid;
  if (scene.terrain && scene.terrain->granular()) {
    const std::string& material = scene.terrain->groundMaterial;
    const terrain::Rectangle& w = *ground.walls;
    const auto add = [&](const Vec3d& normal, double offset) {
      around.walls.push_back({normal, offset, material, "a wall of the terrain"});
    };
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

constexpr double kGiB = 1073741824.0; // [bytes]

double memoryOfMachine() { // [bytes]
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// Throws before any memory is taken when grains cannot fit into this machine.
void checkBlockSizes(const scene::Scene& scene) {
  const double bytes = grainMemory(scene).most();
  for (std::size_t k = 0; k < scene.fills.size(); ++k) {
    const auto grains = static_cast<double>(placedCount(scene.fills[k]));
    if (grains * bytes > memoryOfMachine())
      scene.fail(
          "grains", k, scene.fills[k].form == scene::FillForm::random ? "number" : "radius",
          fmt::format("{} makes {:.3g} grains, {:.3g} GiB; this machine has {:.3g} GiB: use fewer or larger grains",
                      scene.fills[k].form == scene::FillForm::random ? "[-]" : "[m]", grains, grains * bytes / kGiB,
                      memoryOfMachine() / kGiB));
  }
}

/// The same of a bed.
void checkBedSize(const scene::Scene& scene, const terrain::LayerOptions& options) {
  const double bytes = grainMemory(scene).most();
  const scene::Terrain& t = *scene.terrain;
  const double spacing = options.spacingInRadii * options.radius;
  const double layers = options.layers > 0 ? options.layers : std::max(1.0, options.depth / spacing);
  const double grains = t.size[0] * t.size[1] / (spacing * spacing) * layers;
  const double memory = memoryOfMachine();
  if (grains * bytes > memory || grains > 4e9)
    scene.fail("terrain", "grain_radius",
               fmt::format("[m] makes about {:.3g} grains, {:.3g} GiB; this machine has {:.3g} GiB: use larger grains, "
                           "fewer layers or a smaller terrain.size",
                           grains, grains * bytes / kGiB, memory / kGiB));
}

terrain::PartitionOptions partitionOf(const scene::Scene& scene, const base::Comm& comm) {
  terrain::PartitionOptions partition;
  partition.comm = comm;
  partition.rebalance = scene.parallel.rebalance;
  partition.peers = scene.parallel.peerMemory;
  partition.cuts = {scene.parallel.cutsX, scene.parallel.cutsY, scene.parallel.cutsZ};
  // A plane beyond all places that a grain can have is as good at their end, which whole units reach.
  const double end = base::positionScale(2 * grainKinds(scene).largest).limit();
  for (std::vector<double>& planes : partition.cuts)
    for (double& place : planes) place = std::clamp(place, -end, end);
  partition.subdomains = wantedSubdomains(scene);
  checkLattice(scene, comm.size());
  return partition;
}

/// The terrain without its grains. Empty where it has none.
std::optional<terrain::BedPlan> readTerrain(const scene::Scene& scene, Ground& ground) {
  if (!scene.terrain) return {};
  ground.surface = readSurface(scene);
  if (!scene.terrain->granular()) {
    ground.rigid = ground.surface;
    return {};
  }
  const terrain::LayerOptions options = layerOptions(scene);
  checkBedSize(scene, options);
  terrain::BedPlan plan = terrain::planBed(*ground.surface, options);
  ground.rigid = plan.floor, ground.walls = plan.walls, ground.layers = plan.layers;
  checkLevelAcross(scene, *ground.surface);
  return plan;
}

void layBed(const scene::Scene& scene, const terrain::BedPlan& plan, const Surroundings& around, const base::Exec& exec,
            double timeStep, const base::Comm& comm, Ground& ground) {
  const scene::Terrain& t = *scene.terrain;
  const terrain::LayerOptions options = layerOptions(scene);
  const GrainKinds kinds = grainKinds(scene);
  terrain::Boundaries boundaries;
  const terrain::GrainModel model = grainModel(scene, kinds, timeStep, around, boundaries);
  std::optional<TiledBed> tiles;
  std::vector<terrain::GrainSpec> start;
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
      scene.fail("terrain", "tile",
                 "[m] copies a settled bed, which a box, cylinder or plane of the scene reaches into; move that, or "
                 "remove tile");
  } else {
    for (const terrain::Seed& seed : terrain::layGrains(*ground.surface, options))
      if (!taken(seed.centre)) start.push_back({seed.centre, {}, {}, options.radius, kinds.indexOf(t.material)});
  }
  const std::size_t floor = boundaries.walls.size(); // behind the walls, before the surfaces
  ground.grains =
      std::make_unique<terrain::Grains>(exec, model, std::move(boundaries), start, partitionOf(scene, comm));
  if (tiles) tiles->bringToRest(*ground.grains, floor);
}

void placeGrains(const scene::Scene& scene, const std::vector<scene::Grain>& grains, const Surroundings& around,
                 const base::Exec& exec, double timeStep, const base::Comm& comm, Ground& ground) {
  const GrainKinds kinds = grainKinds(scene);
  std::vector<terrain::GrainSpec> start;
  for (const scene::Grain& g : grains)
    start.push_back({g.position, g.velocity, g.spin, g.radius, kinds.indexOf(g.material)});
  terrain::Boundaries boundaries;
  const terrain::GrainModel model = grainModel(scene, kinds, timeStep, around, boundaries);
  ground.grains =
      std::make_unique<terrain::Grains>(exec, model, std::move(boundaries), start, partitionOf(scene, comm));
}

} // namespace

terrain::LayerOptions layerOptions(const scene::Scene& scene) {
  const scene::Terrain& t = *scene.terrain;
  terrain::LayerOptions options;
  options.radius = *t.grainRadius, options.layers = t.layers.value_or(0), options.depth = t.depth.value_or(0);
  options.spacingInRadii = t.spacing, options.jitter = t.jitter, options.packing = t.packing;
  options.floor = t.floor;
  options.seed = static_cast<std::uint64_t>(scene.run.seed);
  options.joined = scene.run.periodic;
  return options;
}

namespace {

/// What stands beside each other in a scene.
void checkCompany(const scene::Scene& scene) {
  const bool placed = !scene.grains.empty() || !scene.fills.empty(), bed = scene.terrain && scene.terrain->granular();
  if (placed && bed)
    scene.fail(
        "terrain", "kind",
        "is a bed of grains beside [[grain]] or [[grains]]; use one of them: a granular terrain, or grains alone");
  if ((placed || !scene.sources.empty()) && scene.terrain && !bed && scene.vehicle)
    scene.fail(
        "vehicle", "",
        "stands beside [[grain]], [[grains]] or [[source]] on rigid [terrain], which is not possible so far; use "
        "a granular terrain, or leave the grains out");
}

} // namespace

void checkGround(const scene::Scene& scene, double timeStep) {
  constexpr std::int64_t kQuick = 100'000; // grains, in about 0.2 s
  checkCompany(scene);
  if (scene.vehicle) checkParts(scene);
  checkSpeeds(scene, timeStep);
  const std::int64_t placed = placedCount(scene);
  if ((placed == 0 && scene.sources.empty()) || placed > kQuick) return;
  Ground ground;
  readTerrain(scene, ground);
  checkStart(scene, placedGrains(scene), surroundingsOf(scene, ground), timeStep);
}

Ground buildGround(const scene::Scene& scene, const base::Exec& exec, double timeStep, const base::Comm& comm) {
  checkCompany(scene);
  if (scene.vehicle) checkParts(scene);
  checkSpeeds(scene, timeStep);
  Ground ground;
  const std::optional<terrain::BedPlan> bed = readTerrain(scene, ground);
  if (!grainKinds(scene).any()) return ground;
  checkBlockSizes(scene);
  const Surroundings around = surroundingsOf(scene, ground);
  const std::vector<scene::Grain> grains = placedGrains(scene);
  checkStart(scene, grains, around, timeStep);
  if (bed)
    layBed(scene, *bed, around, exec, timeStep, comm, ground);
  else
    placeGrains(scene, grains, around, exec, timeStep, comm, ground);
  watchSources(scene, timeStep, *ground.grains);
  return ground;
}

SettleReport settle(const scene::Scene& scene, Ground& ground, const SettleProgress& progress) {
  const scene::Terrain& t = *scene.terrain;
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
    for (std::int64_t i = 0; i < checkEvery;) i += grains.advance(checkEvery - i);
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

} // namespace grouser::setup
