// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/laid_ground.hpp"

#include "base/error.hpp"
#include "coupling/insertion_guard.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace grouser::coupling {

std::vector<std::string> namesOfShapes(const GroundSetup& setup) {
  std::vector<std::string> names;
  for (const SurfaceSetup& s : setup.surfaces)
    if (!s.mesh) names.push_back(s.name);
  return names;
}

bool isTaken(const GroundSetup& setup, const base::Vec3d& centre, double radius) {
  return std::any_of(setup.surfaces.begin(), setup.surfaces.end(),
                     [&](const SurfaceSetup& s) { return startingOverlap(s, centre, radius) > 0; });
}

namespace {

/// Places the bed around existing surfaces.
std::vector<terrain::GrainSpec> laidGrains(const GroundSetup& setup, const BedSetup& bed) {
  std::vector<terrain::GrainSpec> start;
  for (const terrain::Seed& seed : terrain::layBed(*setup.surface, bed.options))
    if (seed.fixed || !isTaken(setup, seed.centre, seed.radius))
      start.push_back({seed.centre, {}, {}, seed.radius, bed.material, seed.fixed});
  return start;
}

} // namespace

LaidGround layGround(const GroundSetup& setup, const base::Exec& exec, const base::Comm& comm,
                     const std::vector<terrain::GrainSpec>* start) {
  LaidGround ground;
  ground.surface = setup.surface, ground.rigid = setup.rigid;
  if (!setup.grains) return ground;
  const GrainsSetup& g = *setup.grains;
  terrain::PartitionOptions partition = g.partition;
  partition.comm = comm;
  ground.grains = std::make_unique<terrain::Grains>(exec, g.model, g.boundaries,
                                                    start   ? *start
                                                    : g.bed ? laidGrains(setup, *g.bed)
                                                            : g.start,
                                                    partition);
  if (g.bed) ground.walls = g.bed->walls;
  guardInsertion(*ground.grains, g.sources, namesOfShapes(setup));
  return ground;
}

void keepSurface(LaidGround& ground, const base::Exec& exec) {
  ground.undisturbed = std::make_shared<terrain::BedSurface>(exec, *ground.grains, ground.rigid->view(), *ground.walls);
}

void keepSurface(LaidGround& ground, const std::vector<double>& heights, double radius) {
  ground.undisturbed = std::make_shared<terrain::BedSurface>(*ground.walls, 2 * radius, heights);
}

std::vector<double> surfaceNow(const LaidGround& ground, const base::Exec& exec) {
  return terrain::BedSurface(exec, *ground.grains, ground.rigid->view(), *ground.walls).heights();
}

terrain::BedExtent extentOf(const LaidGround& ground, const terrain::BedSurface& surface) {
  const terrain::HeightField& floor = *ground.rigid;
  const base::Period& period = ground.grains->system().constants.period;
  return {*ground.walls,
          {period.along(0), period.along(1)},
          [&](double x, double y) { return floor.height(x, y); },
          [&](double x, double y) { return surface.height(x, y); }};
}

terrain::BedStructure structureOf(const LaidGround& ground) {
  return terrain::measureBed(*ground.grains, extentOf(ground, *ground.undisturbed));
}

void checkStructure(const BedSetup& bed, const terrain::BedStructure& structure) {
  constexpr std::int64_t kEnough = 200; // minimum number of grains; with fewer the porosity is too uncertain
  if (!bed.densest || structure.grains < kEnough || 1 - structure.porosity <= *bed.densest) return;
  throw base::SimulationError(
      fmt::format("the settled bed has a solid fraction of {:.4f}, but disordered grains of these radii reach at most "
                  "{:.4f}: it has crystallised ({:.0f} % of its grains lie in crystals); use a wider "
                  "radius_distribution or a larger porosity, or stiffer contacts if overlaps are large",
                  1 - structure.porosity, *bed.densest, 100 * structure.order),
      base::Cause::unsettledBed);
}

std::function<double(double, double)> surfaceHeight(const LaidGround& ground) {
  if (const auto bed = ground.undisturbed) return [bed](double x, double y) { return bed->height(x, y); };
  if (!ground.surface) return {};
  const auto field = std::make_shared<terrain::HeightField>(*ground.surface);
  return [field](double x, double y) { return field->height(x, y); };
}

} // namespace grouser::coupling
