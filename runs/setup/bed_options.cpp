// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/bed_options.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/scene/bed_radii.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/map_notes.hpp"
#include "runs/setup/scm_setup.hpp"
#include "terrain/heightmap.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <utility>

namespace grouser::setup {

namespace {

/// Applies `read` to the scene's height-map; errors name the key.
template <class Read> auto ofHeightmap(const scene::Scene& scene, const Read& read) {
  try {
    return read();
  } catch (const base::InputError& error) {
    scene.fail("terrain", "heightmap", fmt::format("cannot be used: {}", error.what()));
  }
}

terrain::Heightmap readMap(const scene::Scene& scene) {
  return ofHeightmap(scene, [&] { return terrain::loadHeightmap(scene.terrain->heightmap); });
}

terrain::HeightField surfaceOf(const scene::Scene& scene, const terrain::Heightmap& map) {
  const scene::Terrain& t = *scene.terrain;
  terrain::HeightmapPlacement placement;
  placement.sizeX = t.size[0], placement.sizeY = t.size[1];
  placement.black = t.heightRange[0], placement.white = t.heightRange[1];
  placement.interpolation = t.interpolation;
  return ofHeightmap(scene, [&] { return terrain::heightFieldOf(map, placement); });
}

/// A steep place of a surface.
struct SteepPlace {
  double slope, x, y; ///< [-], [m]
};

SteepPlace steepestInCell(const terrain::HeightFieldView& surface, int i, int j) {
  constexpr int kParts = 4; // includes corners and side midpoints of the cell, where single pixels are steepest
  SteepPlace worst{};
  for (int b = 0; b <= kParts; ++b)
    for (int a = 0; a <= kParts; ++a) {
      const double x = surface.xMin + (i + double(a) / kParts) * surface.dx,
                   y = surface.yMin + (j + double(b) / kParts) * surface.dy;
      const terrain::SurfaceJet s = surface.jet(x, y);
      const double slope = std::sqrt(s.hx * s.hx + s.hy * s.hy);
      if (slope > worst.slope) worst = {slope, x, y};
    }
  return worst;
}

/// Height difference [m] between the highest and the lowest pixel within the distance `reach` [m] of a cell.
double riseAbout(const terrain::HeightFieldView& surface, int i, int j, double reach) {
  const int across = static_cast<int>(std::min<double>(reach / surface.dx, surface.columns)),
            along = static_cast<int>(std::min<double>(reach / surface.dy, surface.rows));
  double lowest = surface.heights[static_cast<std::size_t>(j) * surface.columns + i], highest = lowest;
  for (int b = std::max(0, j - along); b <= std::min(surface.rows - 1, j + 1 + along); ++b)
    for (int a = std::max(0, i - across); a <= std::min(surface.columns - 1, i + 1 + across); ++a) {
      const double h = surface.heights[static_cast<std::size_t>(b) * surface.columns + a];
      lowest = std::min(lowest, h), highest = std::max(highest, h);
    }
  return highest - lowest;
}

/// The steepest edge through which grains can be pressed: steeper than 63 degrees and higher than a tenth of a radius.
std::optional<SteepPlace> steepestEdge(const terrain::HeightField& surface, double smallestRadius) {
  constexpr double kSteep = 2; // [-]
  const double least = 0.1 * smallestRadius;
  const terrain::HeightFieldView view = surface.view();
  SteepPlace worst{kSteep, 0, 0};
  if (surface.bounds().slope <= kSteep) return {};
  for (int j = 0; j + 1 < surface.rows(); ++j)
    for (int i = 0; i + 1 < surface.columns(); ++i) {
      if (surface.boundsOfCell(i, j).slope <= worst.slope) continue;
      const SteepPlace here = steepestInCell(view, i, j);
      if (here.slope > worst.slope && riseAbout(view, i, j, least) > least) worst = here;
    }
  return worst.slope > kSteep ? std::optional(worst) : std::nullopt;
}

} // namespace

terrain::HeightField readSurface(const scene::Scene& scene) { return surfaceOf(scene, readMap(scene)); }

std::optional<terrain::HeightField> floorShape(const scene::Scene& scene) {
  if (!scene.terrain) return {};
  const scene::Terrain& t = *scene.terrain;
  if (!t.granular() || t.floor == terrain::FloorShape::follow) return readSurface(scene);
  return terrain::HeightField::flat({0, t.size[0], -0.5 * t.size[1], 0.5 * t.size[1]}, 0);
}

TerrainRemarks terrainRemarks(const scene::Scene& scene) {
  if (!scene.terrain) return {};
  const terrain::Heightmap map = readMap(scene);
  const std::string name = fmt::format("terrain.heightmap = {}", scene.terrain->heightmap);
  TerrainRemarks remarks;
  if (map.colour)
    remarks.notes.push_back(name + " is a colour image; its luminance (0.2126 red + 0.7152 green + 0.0722 blue) is "
                                   "used as height; save it as greyscale to avoid this note");
  if (map.transparent)
    remarks.notes.push_back(name + " has transparent pixels; the alpha channel is ignored; save the image without it");
  if (std::string warning = nodeSpacingWarning(scene); !warning.empty()) remarks.warnings.push_back(std::move(warning));
  for (std::string& note : mapNotes(scene, map)) remarks.notes.push_back(std::move(note));
  if (!scene.terrain->granular() || scene.terrain->floor == terrain::FloorShape::flat) return remarks;
  if (const std::optional<SteepPlace> edge = steepestEdge(surfaceOf(scene, map), bedOptions(scene).smallestRadius()))
    remarks.warnings.push_back(
        fmt::format("the floor below the bed follows {}, which has a slope of {:.3g} m/m ({:.0f} degrees) at ({:.4g}, "
                    "{:.4g}) m; such steep edges can let grains through during settling; set terrain.floor = \"flat\", "
                    "or spread the edge over more pixels",
                    name, edge->slope, base::atan2(edge->slope, 1.0) * 180 / base::kPi, edge->x, edge->y));
  return remarks;
}

namespace {

terrain::LayerOptions layerOptions(const scene::Scene& scene) {
  const scene::Terrain& t = *scene.terrain;
  terrain::LayerOptions options;
  options.radius = *t.grainRadius, options.layers = t.layers.value_or(0), options.depth = t.depth.value_or(0);
  options.spacingInRadii = *t.spacing, options.jitter = *t.jitter, options.packing = *t.packing;
  options.floor = t.floor;
  options.seed = static_cast<std::uint64_t>(scene.run.seed);
  options.periodic = scene.run.periodic;
  return options;
}

terrain::RandomBedOptions randomOptions(const scene::Scene& scene) {
  const scene::Terrain& t = *scene.terrain;
  terrain::RandomBedOptions options;
  options.radii = scene::bedRadii(t);
  options.grading = {t.fineDepth.value_or(0), t.coarsening.value_or(0), t.coarsestRadius.value_or(0)};
  options.depth = *t.depth, options.porosity = t.porosity.value_or(scene::Terrain::kPoured);
  options.floor = t.floor, options.roughFloor = t.floorGrains;
  options.seed = static_cast<std::uint64_t>(scene.run.seed);
  options.periodic = scene.run.periodic;
  return options;
}

} // namespace

terrain::BedOptions bedOptions(const scene::Scene& scene) {
  const scene::Terrain& t = *scene.terrain;
  terrain::BedOptions options;
  terrain::FloorGrainOptions floor{{}, 1, scene.run.periodic, static_cast<std::uint64_t>(scene.run.seed)};
  if (t.lattice()) {
    options.grains = layerOptions(scene);
    floor.radii.radius = *t.grainRadius;
  } else {
    const terrain::RandomBedOptions random = randomOptions(scene);
    options.grains = random;
    floor.radii = random.radii, floor.scale = random.grading.scaleAt(random.depth, random.radii.medianRadius());
  }
  if (t.floorGrains) options.floorGrains = floor;
  return options;
}

} // namespace grouser::setup
