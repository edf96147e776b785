// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/bed_options.hpp"

#include "base/error.hpp"
#include "runs/scene/bed_radii.hpp"
#include "terrain/heightmap.hpp"

#include <cstdint>
#include <fmt/format.h>

namespace grouser::setup {

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
