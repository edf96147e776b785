// SPDX-License-Identifier: BSD-3-Clause
#include "runs/simulation/ground.hpp"

#include "base/error.hpp"
#include "runs/simulation/insertion_guard.hpp"
#include "runs/simulation/tiled_bed.hpp"
#include "terrain/bed_tops.hpp"
#include "terrain/layers.hpp"

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
  const double radius = bed.layers.radius;
  for (const terrain::Seed& seed : terrain::layGrains(*setup.surface, bed.layers))
    if (!isTaken(setup, seed.centre, radius)) start.push_back({seed.centre, {}, {}, radius, bed.material});
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
  std::vector<terrain::GrainSpec> start = tiles.start(bed.layers.radius, bed.material);
  if (std::any_of(start.begin(), start.end(),
                  [&](const auto& g) { return isTaken(setup, g.position, bed.layers.radius); }))
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
    const TiledBed tiles(*g.bed->tile, *settledTile(*g.bed->tile, exec), *setup.surface, g.bed->layers.radius);
    make(tiledGrains(setup, *g.bed, tiles));
    tiles.bringToRest(*ground.grains, g.boundaries.walls.size()); // the floor stands behind the walls
  }
  if (g.bed) ground.walls = g.bed->walls;
  guardInsertion(*ground.grains, g.sources, namesOfShapes(setup));
  return ground;
}

namespace {

SettleReport settleUntilRest(const setup::BedSetup& bed, terrain::Grains& grains, const SettleProgress& progress) {
  const setup::SettleSetup& wanted = bed.settle;
  const terrain::GrainModel& model = grains.model();
  const double g = norm(model.gravity), dt = model.timeStep;
  const double unit = model.mass * g * model.radius * static_cast<double>(grains.count());
  // Loose layers fall first; nothing is judged before they have landed.
  const double layers = bed.tile ? 0 : bed.layerCount;
  const double fall = std::sqrt(2 * layers * (bed.layers.spacingInRadii - 1.6) * model.radius / g);
  const auto checkEvery = std::max<std::int64_t>(1, static_cast<std::int64_t>(0.02 / dt));
  SettleReport report;
  double forceRatio = 0;
  int calm = 0;
  while (report.time < wanted.timeLimit) {
    try {
      for (std::int64_t i = 0; i < checkEvery;) i += grains.advance(checkEvery - i);
    } catch (const base::SimulationError& error) {
      throw base::SimulationError(fmt::format("while the {} settled, before the run begins: {}",
                                              bed.tile ? "bed of copied tiles" : "bed", error.what()));
    }
    report.steps += checkEvery;
    report.time = static_cast<double>(report.steps) * dt;
    if (wanted.forceRatio) forceRatio = grains.forceRatio(); // before anything else is done with the step
    const terrain::GrainLedger ledger = grains.ledger();
    report.agitation = (ledger.kinetic + ledger.rotational) / unit;
    progress(report.time, report.agitation);
    const bool rests =
        report.agitation < wanted.kineticEnergy && (!wanted.forceRatio || forceRatio < *wanted.forceRatio);
    calm = rests ? calm + 1 : 0;
    if (calm >= 5 && report.time > fall) return report;
  }
  throw base::SimulationError(
      fmt::format("the bed has not settled within {:g} s: kinetic energy a grain is {:.3g} of m g "
                  "radius, wanted is {:.3g}{}; raise terrain.settle_time_limit, lower the material's "
                  "restitution or raise terrain.settle_kinetic_energy{}",
                  wanted.timeLimit, report.agitation, wanted.kineticEnergy,
                  wanted.forceRatio ? fmt::format(", and the mean resultant force on a grain is {:.3g} of its weight, "
                                                  "wanted is {:.3g}",
                                                  forceRatio, *wanted.forceRatio)
                                    : "",
                  wanted.forceRatio ? " and settle_force_ratio" : ""));
}

} // namespace

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

SettleReport settle(const setup::BedSetup& bed, terrain::Grains& grains, const SettleProgress& progress) {
  try {
    SettleReport report = settleUntilRest(bed, grains, progress);
    measureHeight(bed, grains, report);
    return report;
  } catch (const base::SimulationError& error) {
    if (progress.failed) progress.failed(grains, error.what());
    throw;
  }
}

void keepSurface(Ground& ground, const base::Exec& exec) {
  ground.undisturbed = std::make_shared<terrain::BedSurface>(exec, *ground.grains, ground.rigid->view(), *ground.walls);
}

void keepSurface(Ground& ground, const std::vector<double>& heights, double radius) {
  ground.undisturbed = std::make_shared<terrain::BedSurface>(*ground.walls, 2 * radius, heights);
}

std::function<double(double, double)> surfaceHeight(const Ground& ground) {
  if (const auto bed = ground.undisturbed) return [bed](double x, double y) { return bed->height(x, y); };
  if (!ground.surface) return {};
  const auto field = std::make_shared<terrain::HeightField>(*ground.surface);
  return [field](double x, double y) { return field->height(x, y); };
}

} // namespace grouser::simulation
