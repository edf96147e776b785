// SPDX-License-Identifier: BSD-3-Clause
#include "runs/simulation/ground.hpp"

#include "base/error.hpp"
#include "runs/simulation/bed_preparation.hpp"
#include "runs/simulation/insertion_guard.hpp"
#include "runs/simulation/tiled_bed.hpp"
#include "terrain/bed_tops.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::simulation {

using base::Vec3d;

namespace {

/// The bed is laid around what stands in it.
bool isTaken(const setup::GroundSetup& setup, const Vec3d& centre, double radius) {
  return std::any_of(setup.surfaces.begin(), setup.surfaces.end(),
                     [&](const setup::SurfaceSetup& s) { return setup::startingOverlap(s, centre, radius) > 0; });
}

std::vector<terrain::GrainSpec> laidGrains(const setup::GroundSetup& setup, const setup::BedSetup& bed) {
  std::vector<terrain::GrainSpec> start;
  for (const terrain::Seed& seed : terrain::layBed(*setup.surface, bed.options))
    if (seed.fixed || !isTaken(setup, seed.centre, seed.radius))
      start.push_back({seed.centre, {}, {}, seed.radius, bed.material, seed.fixed});
  return start;
}

/// The grains of a tile, come to rest. Throws SimulationError where they do not. Every rank has all of them.
std::unique_ptr<terrain::Grains> settledTile(const setup::TileSetup& tile, const base::Exec& exec) {
  Ground ground = buildGround(*tile.ground, exec);
  const setup::BedSetup& bed = *tile.ground->grains->bed;
  if (bed.settle.timeLimit > 0) settle(bed, *ground.grains, [](double, double) {});
  return std::move(ground.grains);
}

std::vector<terrain::GrainSpec> tiledGrains(const setup::GroundSetup& setup, const setup::BedSetup& bed,
                                            const TiledBed& tiles) {
  std::vector<terrain::GrainSpec> start = tiles.start(bed.material);
  if (std::any_of(start.begin(), start.end(),
                  [&](const auto& g) { return !g.fixed && isTaken(setup, g.position, g.radius); }))
    throw base::InputError(bed.tile->inTheWay);
  return start;
}

} // namespace

std::vector<std::string> namesOfShapes(const setup::GroundSetup& setup) {
  std::vector<std::string> names;
  for (const setup::SurfaceSetup& s : setup.surfaces)
    if (!s.mesh) names.push_back(s.name);
  return names;
}

Ground buildGround(const setup::GroundSetup& setup, const base::Exec& exec, const base::Comm& comm) {
  Ground ground;
  ground.surface = setup.surface, ground.rigid = setup.rigid;
  if (!setup.grains) return ground;
  const setup::GrainsSetup& g = *setup.grains;
  if (g.bed && g.bed->alone) return buildGround(*g.bed->alone, exec, comm);
  terrain::PartitionOptions partition = g.partition;
  partition.comm = comm;
  const auto make = [&](const std::vector<terrain::GrainSpec>& start) {
    ground.grains = std::make_unique<terrain::Grains>(exec, g.model, g.boundaries, start, partition);
  };
  if (!g.bed) {
    make(g.start);
  } else if (!g.bed->tile) {
    make(laidGrains(setup, *g.bed));
  } else {
    const TiledBed tiles(*g.bed->tile, *settledTile(*g.bed->tile, exec), *setup.surface);
    make(tiledGrains(setup, *g.bed, tiles));
    tiles.bringToRest(*ground.grains, g.boundaries.walls.size()); // the floor stands behind the walls
  }
  if (g.bed) ground.walls = g.bed->walls;
  guardInsertion(*ground.grains, g.sources, namesOfShapes(setup));
  return ground;
}

namespace {

/// Fills in how high the bed stands.
void measureHeight(const setup::BedSetup& bed, const terrain::Grains& grains, SettleReport& report) {
  const terrain::Rectangle& w = bed.walls;
  const double diameter = 2 * grains.model().radius;
  const auto nodes = [&](double length) { return std::max(2, static_cast<int>(std::ceil(length / diameter)) + 1); };
  const terrain::NodeGrid fine{nodes(w.width()),
                               nodes(w.length()),
                               w.width() / (nodes(w.width()) - 1),
                               w.length() / (nodes(w.length()) - 1),
                               w.xMin,
                               w.yMin};
  double sum = 0, highest = -1e300;
  std::int64_t covered = 0;
  for (const double top : terrain::highestTops(grains.system().exec, grains, fine, diameter)) {
    if (!std::isfinite(top)) continue;
    sum += top, ++covered;
    highest = std::max(highest, top);
  }
  if (covered == 0) return;
  report.highest = highest, report.meanHeight = sum / static_cast<double>(covered);
}

} // namespace

SettleReport settle(const setup::BedSetup& bed, terrain::Grains& grains, const SettleProgress& progress) {
  SettleReport report;
  try {
    if (bed.preparation) {
      report.friction = frictionFor(*bed.preparation, grains.system().exec, progress);
      settleWithFriction(bed, grains, report.friction, progress, report);
    } else {
      settleUntilRest(bed, bed.settle, grains, bed.fall, progress, report);
    }
  } catch (const base::SimulationError& error) {
    if (progress.failed) progress.failed(grains, error.what());
    throw;
  }
  measureHeight(bed, grains, report);
  return report;
}

void keepSurface(Ground& ground, const base::Exec& exec) {
  ground.undisturbed = std::make_shared<terrain::BedSurface>(exec, *ground.grains, ground.rigid->view(), *ground.walls);
}

void keepSurface(Ground& ground, const std::vector<double>& heights, double radius) {
  ground.undisturbed = std::make_shared<terrain::BedSurface>(*ground.walls, 2 * radius, heights);
}

terrain::BedStructure structureOf(const Ground& ground) {
  const terrain::BedSurface& surface = *ground.undisturbed;
  const terrain::HeightField& floor = *ground.rigid;
  const base::Period& period = ground.grains->system().constants.period;
  return terrain::measureBed(*ground.grains, {*ground.walls,
                                              {period.length[0] > 0, period.length[1] > 0},
                                              [&](double x, double y) { return floor.height(x, y); },
                                              [&](double x, double y) { return surface.height(x, y); }});
}

void checkStructure(const setup::BedSetup& bed, const terrain::BedStructure& structure) {
  constexpr std::int64_t kEnough = 200; // grains; of fewer the porosity says little
  if (!bed.densest || structure.grains < kEnough || 1 - structure.porosity <= *bed.densest) return;
  throw base::SimulationError(
      fmt::format("the settled bed has a solid fraction of {:.4f}, and disordered grains of these radii reach at most "
                  "{:.4f}: it has crystallised ({:.0f} % of its grains lie in crystals); give it a wider "
                  "radius_distribution or a larger porosity, or stiffer contacts if they overlap much",
                  1 - structure.porosity, *bed.densest, 100 * structure.order));
}

std::function<double(double, double)> surfaceHeight(const Ground& ground) {
  if (const auto bed = ground.undisturbed) return [bed](double x, double y) { return bed->height(x, y); };
  if (!ground.surface) return {};
  const auto field = std::make_shared<terrain::HeightField>(*ground.surface);
  return [field](double x, double y) { return field->height(x, y); };
}

} // namespace grouser::simulation
