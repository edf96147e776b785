// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/ground_setup.hpp"

#include "base/error.hpp"
#include "base/sphere.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/bed_alone.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/grain_model.hpp"
#include "runs/setup/grain_space.hpp"
#include "runs/setup/lattice.hpp"
#include "runs/setup/laws.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/obstacles.hpp"
#include "runs/setup/periodic_boundaries.hpp"
#include "runs/setup/placement.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/setup/scm_setup.hpp"
#include "runs/setup/size_checks.hpp"
#include "runs/setup/sources.hpp"
#include "runs/setup/start_checks.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/setup/vehicle_setup.hpp"
#include "runs/setup/vehicle_surface.hpp"
#include "runs/setup/vehicle_surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::setup {

using base::Vec3d;

namespace {

terrain::PartitionOptions partitionOf(const scene::Scene& scene, const GrainKinds& kinds, int ranks) {
  checkLattice(scene, ranks);
  return partitionOptions(scene, base::positionScale(2 * kinds.largest));
}

/// Reads the terrain into `ground`, without placing grains. Returns the plan of a bed of grains; empty for other
/// terrain.
std::optional<terrain::BedPlan> readTerrain(const scene::Scene& scene, coupling::GroundSetup& ground,
                                            SizeChecks sizes) {
  if (!scene.terrain) return {};
  ground.area = terrainArea(scene);
  ground.surface = readSurface(scene);
  if (!scene.terrain->granular()) {
    ground.rigid = ground.surface;
    if (const std::optional<coupling::ScmSetup> scm = scmSetup(scene))
      ground.otherKind = [scm](const coupling::GroundSetup& setup, const base::Exec&) {
        return std::make_unique<coupling::ScmGround>(*scm, *setup.surface);
      };
    return {};
  }
  const terrain::BedOptions options = bedOptions(scene);
  if (sizes == SizeChecks::due) checkBedSize(scene);
  terrain::BedPlan plan = terrain::planBed(*ground.surface, options);
  ground.rigid = plan.floor;
  checkLevelAcross(scene, *ground.surface);
  return plan;
}

/// A level piece of the bed as a separate scene, without anything else and with vertical gravity. `layers`: layers of a
/// lattice; `depth`: depth of a random bed [m].
scene::Scene pieceScene(const scene::Scene& scene, int layers, double depth, const std::array<double, 2>& size) {
  scene::Scene piece = scene;
  piece.run.periodic = {true, true};
  piece.run.gravity = {0, 0, -norm(scene.run.gravity)}; // a periodic piece would slide under inclined gravity
  piece.grains.clear(), piece.fills.clear(), piece.sources.clear();
  piece.planes.clear(), piece.boxes.clear(), piece.cylinders.clear(), piece.meshes.clear();
  removeVehicle(piece), piece.mechanism = {}, piece.parallel = {};
  scene::Terrain& t = *piece.terrain;
  t.tile.reset();
  t.size = size;
  t.heightRange = {0, 0};
  t.floor = terrain::FloorShape::follow;
  t.layers.reset(), t.depth.reset();
  if (t.lattice())
    t.layers = layers;
  else
    t.depth = depth;
  t.cache = false;
  return piece;
}

/// Returns the message of the error that `fail` throws, for an error that may occur later.
template <class Fail> std::string messageOf(const Fail& fail) {
  try {
    fail();
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

coupling::TileSetup tileSetup(const scene::Scene& scene, const terrain::HeightField& surface,
                              const terrain::BedPlan& plan, double timeStep) {
  const scene::Terrain& t = *scene.terrain;
  const double radius = *t.grainRadius;
  const terrain::HeightFieldBounds floor = plan.floor.bounds(), top = surface.bounds();
  if (floor.highest - floor.lowest > 1e-6 * radius)
    scene.fail("terrain", "tile",
               fmt::format("[m] requires a level floor, but floor = \"{}\" follows terrain.heightmap from {:g} to {:g} "
                           "m; set terrain.floor = \"flat\", or remove tile",
                           base::wordOf(t.floor), floor.lowest, floor.highest));
  coupling::TileSetup tile;
  tile.periodic = scene.run.periodic, tile.terrainSize = t.size;
  tile.walls = plan.walls, tile.floorHeight = floor.lowest;
  // Between periodic boundaries, whole tiles must fit. Between walls, a tile must contain whole lattice cells, and
  // walls cut the last tile.
  const double cell = t.spacing.value_or(0) * radius;
  for (std::size_t a = 0; a < 2; ++a) {
    const double wanted = std::min((*t.tile)[a], t.size[a]);
    if (tile.periodic[a]) {
      tile.copies[a] = std::max<std::int64_t>(1, std::llround(t.size[a] / wanted));
      tile.size[a] = t.size[a] / static_cast<double>(tile.copies[a]);
    } else {
      tile.size[a] = cell > 0 ? std::floor(wanted / cell + 0.5) * cell : wanted;
      tile.copies[a] = static_cast<std::int64_t>(std::ceil(t.size[a] / tile.size[a]));
    }
  }
  const double depth =
      t.lattice() ? 0 : *t.depth + (t.floor == terrain::FloorShape::flat ? top.highest - top.lowest : 0);
  tile.ground = std::make_shared<const coupling::GroundSetup>(
      groundSetup(pieceScene(scene, plan.layers, depth, tile.size), timeStep));
  tile.inTheWay = messageOf([&] {
    scene.fail("terrain", "tile",
               "[m] is incompatible with a box, cylinder or plane inside the bed; move that surface, or remove tile");
  });
  return tile;
}

/// A small level bed of the same grains between periodic boundaries, wide enough for a representative porosity.
coupling::PreparationSetup preparationSetup(const scene::Scene& scene, const terrain::BedOptions& options,
                                            double timeStep) {
  constexpr double kWidth = 14, kDepth = 14, kWidthOfLargest = 7; // [diameters]
  const scene::Terrain& t = *scene.terrain;
  const double mean = 2 * options.meanRadius(), largest = 2 * options.largestRadius();
  const double width = std::max(kWidth * mean, kWidthOfLargest * largest);
  scene::Scene sample =
      pieceScene(scene, 0, t.coarsening ? *t.depth : std::min(*t.depth, kDepth * mean), {width, width});
  sample.run.seed = 1; // sample: another bed of the same soil
  sample.terrain->porosity.reset();
  if (scene.material(t.material).friction <= 0)
    scene.fail("terrain", "porosity",
               "[-] is reached by adjusting the grain friction during settling, but the friction of the bed material "
               "is 0; remove it, or set the friction of the material");
  return {*t.porosity, std::make_shared<const coupling::GroundSetup>(groundSetup(sample, timeStep)),
          messageOf([&] { scene.fail("terrain", "porosity", "[-]"); }),
          t.cache ? fmt::format("porosity {:a}\n{}", *t.porosity, bedOrigin(sample, timeStep)) : ""};
}

coupling::BedSetup bedSetup(const scene::Scene& scene, const GrainKinds& kinds, const terrain::HeightField& surface,
                            const terrain::BedPlan& plan, double timeStep) {
  constexpr double kCrystal = 0.006; // excess over random close packing [-], by overlaps and small samples
  const scene::Terrain& t = *scene.terrain;
  coupling::BedSetup bed;
  bed.options = bedOptions(scene), bed.walls = plan.walls;
  bed.fall = t.tile ? 0 : plan.fall;
  bed.restEnergy = scene.material(t.material).density * bed.options.meanVolume() * norm(scene.run.gravity) *
                   bed.options.meanRadius();
  const auto* random = std::get_if<terrain::RandomBedOptions>(&bed.options.grains);
  if (random) bed.restEnergy *= random->grading.meanFourthPower(random->depth, random->radii.medianRadius());
  bed.material = kinds.indexOf(t.material);
  bed.settle = {t.settleTimeLimit, t.settleKineticEnergy, t.settleForceRatio, t.lattice()};
  bed.cache = t.cache;
  if (isPutOnBed(scene)) return bed; // then sceneOfBed() determines the settings
  if (bed.cache) bed.origin = bedOrigin(scene, timeStep);
  if (t.tile) bed.tile = tileSetup(scene, surface, plan, timeStep);
  if (random) bed.densest = terrain::randomClosePacking(random->radii) + kCrystal;
  if (t.porosity && !t.tile) bed.preparation = preparationSetup(scene, bed.options, timeStep);
  return bed;
}

/// Contact laws between each grain material and the parts of a vehicle, meshes or bodies.
contact::GrainPartMaterials partLaws(const scene::Scene& scene, const GrainKinds& kinds, double grainMass) {
  contact::GrainPartMaterials all;
  const std::optional<VehicleSurface> ofSoil = vehicleSurface(scene);
  std::vector<std::string> parts = shapeMaterials(scene);
  if (scene.vehicle)
    parts.insert(parts.begin(), scene.vehicle->material);
  else if (parts.empty() && !scene.meshes.empty())
    parts = {scene.meshes.front().material};
  if (parts.empty()) return all;
  // If all grains have one mass, damping is a constant; otherwise it depends on the effective mass of each contact.
  const std::optional<double> mass = kinds.many() ? std::nullopt : std::optional(grainMass);
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const std::string& soil : kinds.material) {
      const bool likeSoil = ofSoil && p == 0; // a vehicle without a material
      // Patches on parts keep springs, but no plastic state.
      const contact::ContactLaw law = pairLaw(scene, soil, likeSoil ? soil : parts[p], mass).elastic();
      all.laws.push_back(likeSoil ? ofSoil->with(law) : law);
    }
  for (const std::string& soil : kinds.material) {
    all.massPerCube.push_back(base::sphereMass(scene.material(soil).density, 1));
    all.crushing.push_back(scene.material(soil).crushingStrength.value_or(0));
  }
  return all;
}

/// The grains of [[grain]] and [[grains]] by section.
std::vector<coupling::PlacedGrains> grainsOnBed(const scene::Scene& scene, const std::vector<terrain::GrainSpec>& all) {
  std::vector<coupling::PlacedGrains> placed;
  auto next = all.begin();
  const auto take = [&](const char* list, std::size_t number, std::int64_t count, std::optional<double> aboveBed) {
    placed.push_back({scene.placeOf(list, number), {next, next + count}, aboveBed});
    next += count;
  };
  for (std::size_t k = 0; k < scene.grains.size(); ++k) take("grain", k, 1, scene.grains[k].aboveBed);
  for (std::size_t k = 0; k < scene.fills.size(); ++k)
    take("grains", k, placedCount(scene.fills[k]), scene.fills[k].aboveBed);
  return placed;
}

/// Checks for incompatible sections.
void checkCompatibility(const scene::Scene& scene) {
  const bool placed = !scene.grains.empty() || !scene.fills.empty(), bed = scene.terrain && scene.terrain->granular();
  if ((placed || !scene.sources.empty()) && scene.terrain && !bed && scene.vehicle)
    scene.fail("vehicle", "",
               "on rigid [terrain] is incompatible with [[grain]], [[grains]] and [[source]]; use a granular terrain, "
               "or remove the grains");
}

} // namespace

void checkGround(const scene::Scene& scene, double timeStep) {
  constexpr std::int64_t kQuick = 100'000; // grains, in about 0.2 s
  checkCompatibility(scene);
  checkVehicleSurroundings(scene);
  const ContactPairs pairs(scene);
  checkSpeeds(scene, pairs, timeStep);
  checkPeriodicSides(scene, pairs.kinds, timeStep);
  checkSurfacesBetweenSides(scene, pairs);
  const std::int64_t placed = placedCount(scene);
  if ((placed == 0 && scene.sources.empty()) || placed > kQuick) return;
  coupling::GroundSetup ground;
  const std::optional<terrain::BedPlan> bed = readTerrain(scene, ground, SizeChecks::due);
  const Surroundings around = surroundingsOf(scene, pairs, ground.rigid, bed ? bed->walls : terrain::Rectangle{});
  checkStart(scene, pairs.kinds, placedGrains(scene), around, timeStep);
}

coupling::GroundSetup groundSetup(const scene::Scene& scene, double timeStep, int ranks, SizeChecks sizes) {
  checkCompatibility(scene);
  checkVehicleSurroundings(scene);
  const ContactPairs pairs(scene);
  const GrainKinds& kinds = pairs.kinds;
  checkSpeeds(scene, pairs, timeStep);
  checkPeriodicSides(scene, pairs.kinds, timeStep);
  checkSurfacesBetweenSides(scene, pairs);
  coupling::GroundSetup ground;
  const std::optional<terrain::BedPlan> bed = readTerrain(scene, ground, sizes);
  ground.obstacles = obstaclesOf(scene);
  if (!kinds.any()) return ground;
  if (sizes == SizeChecks::due) checkFillSizes(scene);
  const Surroundings around = surroundingsOf(scene, pairs, ground.rigid, bed ? bed->walls : terrain::Rectangle{});
  const std::vector<scene::Grain> placed = placedGrains(scene);
  checkStart(scene, kinds, placed, around, timeStep);
  ground.surfaces.assign(around.surfaces.begin(), around.surfaces.end());
  coupling::GrainsSetup& grains = ground.grains.emplace();
  grains.model = grainModel(scene, kinds, timeStep, around, grains.boundaries);
  for (const Surroundings::Wall& wall : around.walls) grains.wallNames.push_back(wall.name);
  grains.manyKinds = kinds.many(), grains.materials = kinds.material;
  for (const scene::Grain& g : placed)
    grains.start.push_back({g.position, g.velocity, g.spin, g.radius, kinds.indexOf(g.material), g.fixed});
  const auto isHertz = [](const scene::Material& m) { return m.hertzian(); };
  if (std::any_of(scene.materials.begin(), scene.materials.end(), isHertz)) grains.impactSpeed = scene.run.impactSpeed;
  if (bed) {
    grains.bed = bedSetup(scene, kinds, *ground.surface, *bed, timeStep);
    grains.onBed = grainsOnBed(scene, grains.start);
    grains.start.clear();
    if (isPutOnBed(scene)) {
      const scene::Scene alone = sceneOfBed(scene);
      grains.bed->alone = std::make_shared<const coupling::GroundSetup>(
          groundSetup(alone, chooseTimeStep(alone), ranks, SizeChecks::passed));
    }
  }
  grains.sources = sourcesOf(scene, kinds, timeStep);
  grains.partition = partitionOf(scene, kinds, ranks);
  grains.partLaws = partLaws(scene, kinds, grains.model.mass);
  return ground;
}

} // namespace grouser::setup
