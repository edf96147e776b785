// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/bed_options.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/scene/bed_radii.hpp"
#include "terrain/heightmap.hpp"

#include <cmath>
#include <cstdint>
#include <fmt/format.h>

namespace grouser::setup {

terrain::HeightField readSurface(const scene::Scene& scene) {
  const scene::Terrain& t = *scene.terrain;
  terrain::HeightmapPlacement placement;
  placement.sizeX = t.size[0], placement.sizeY = t.size[1];
  placement.black = t.heightRange[0], placement.white = t.heightRange[1];
  placement.interpolation = t.interpolation;
  try {
    return terrain::heightFieldOf(terrain::loadHeightmap(t.heightmap), placement);
  } catch (const base::InputError& error) {
    scene.fail("terrain", "heightmap", fmt::format("is of no use: {}", error.what()));
  }
}

std::vector<std::string> terrainNotes(const scene::Scene& scene) {
  if (!scene.terrain) return {};
  const terrain::Heightmap map = terrain::loadHeightmap(scene.terrain->heightmap);
  const std::string name = fmt::format("terrain.heightmap = {}", scene.terrain->heightmap);
  std::vector<std::string> notes;
  if (map.colour)
    notes.push_back(name + " is a picture in colour: heights follow its luminance, 0.2126 red + 0.7152 green + 0.0722 "
                           "blue; save it in grey if that is not meant");
  if (map.transparent)
    notes.push_back(name + " has transparent pixels: heights follow their colour, alpha is ignored; save the picture "
                           "without an alpha channel");
  return notes;
}

std::vector<std::string> terrainWarnings(const scene::Scene& scene) {
  constexpr double kSteep = 2; // [-]
  if (!scene.terrain || !scene.terrain->granular() || scene.terrain->floor == terrain::FloorShape::flat) return {};
  const terrain::HeightField surface = readSurface(scene);
  if (surface.bounds().slope <= kSteep) return {};
  const terrain::HeightFieldView view = surface.view();
  double steepest = 0, x = 0, y = 0;
  for (int j = 0; j + 1 < surface.rows(); ++j)
    for (int i = 0; i + 1 < surface.columns(); ++i) {
      const double atX = view.xMin + (i + 0.5) * view.dx, atY = view.yMin + (j + 0.5) * view.dy;
      const terrain::SurfaceJet s = view.jet(atX, atY);
      const double slope = std::sqrt(s.hx * s.hx + s.hy * s.hy);
      if (slope > steepest) steepest = slope, x = atX, y = atY;
    }
  if (steepest <= kSteep) return {};
  return {fmt::format(
      "the floor below the bed follows terrain.heightmap = {}, which rises by {:.3g} m a metre ({:.0f} degrees) at "
      "({:.4g}, {:.4g}) m: grains can be pressed through such an edge while the bed settles; set terrain.floor = "
      "\"flat\", or spread the edge over more pixels",
      scene.terrain->heightmap, steepest, base::atan2(steepest, 1.0) * 180 / base::kPi, x, y)};
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
