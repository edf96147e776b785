// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_count.hpp"

#include "runs/setup/bed_layers.hpp"
#include "runs/setup/grain_kinds.hpp"
#include "terrain/layers.hpp"

namespace grouser::setup {

std::int64_t bedGrains(const scene::Scene& scene) {
  return terrain::planBed(readSurface(scene), layerOptions(scene)).grains;
}

std::int64_t plannedGrains(const scene::Scene& scene) {
  std::int64_t grains = placedCount(scene);
  for (const scene::Source& s : scene.sources) grains += s.total;
  return grains + (scene.terrain && scene.terrain->granular() ? bedGrains(scene) : 0);
}

} // namespace grouser::setup
