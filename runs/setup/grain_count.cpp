// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_count.hpp"

#include "runs/scene/scene.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/grain_kinds.hpp"
#include "terrain/bed.hpp"

namespace grouser::setup {

BedGrains bedGrains(const scene::Scene& scene) {
  const terrain::BedOptions options = bedOptions(scene);
  const terrain::BedPlan plan = terrain::planBed(readSurface(scene), options);
  return {plan.grains, terrain::fixedGrains(plan, options)};
}

std::int64_t plannedGrains(const scene::Scene& scene) {
  std::int64_t grains = placedCount(scene);
  for (const scene::Source& s : scene.sources) grains += s.total;
  if (!scene.terrain || !scene.terrain->granular()) return grains;
  const BedGrains bed = bedGrains(scene);
  return grains + bed.loose + bed.fixed;
}

} // namespace grouser::setup
