// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_count.hpp"

#include "runs/setup/bed_options.hpp"
#include "runs/setup/grain_kinds.hpp"
#include "terrain/bed.hpp"

namespace grouser::setup {

namespace {

std::int64_t bedGrains(const scene::Scene& scene) {
  const terrain::BedOptions options = bedOptions(scene);
  const terrain::BedPlan plan = terrain::planBed(readSurface(scene), options);
  return plan.grains + terrain::fixedGrains(plan, options);
}

} // namespace

std::int64_t plannedGrains(const scene::Scene& scene) {
  std::int64_t grains = placedCount(scene);
  for (const scene::Source& s : scene.sources) grains += s.total;
  return grains + (scene.terrain && scene.terrain->granular() ? bedGrains(scene) : 0);
}

} // namespace grouser::setup
