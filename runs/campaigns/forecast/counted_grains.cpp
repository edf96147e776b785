// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/forecast/counted_grains.hpp"

#include "coupling/laid_ground.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/grain_count.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/support/stopwatch.hpp"
#include "terrain/bed.hpp"

#include <algorithm>

namespace grouser::forecast {

CountedGrains countGrains(const scene::Scene& scene, double timeStep, std::int64_t maxLaid) {
  CountedGrains counted;
  counted.grains = setup::plannedGrains(scene);
  if (!scene.terrain || !scene.terrain->granular()) return counted;
  if (scene.terrain->tile) {
    counted.exact = false;
    counted.doubt = "estimated from the volume to within a few percent (walls cut the copies of a tile)";
    return counted;
  }
  if (counted.grains > maxLaid) {
    counted.exact = scene.terrain->lattice();
    if (!counted.exact) counted.doubt = "estimated from the volume to within a few tenths of a percent";
    return counted;
  }
  const coupling::GroundSetup whole = setup::groundSetup(scene, timeStep);
  const coupling::BedSetup& placed = *whole.grains->bed;
  const coupling::GroundSetup& ground = placed.alone ? *placed.alone : whole; // ground in which the bed is laid
  const support::Stopwatch laying;
  const std::vector<terrain::Seed> seeds = terrain::layBed(*ground.surface, ground.grains->bed->options);
  const auto laid = std::count_if(seeds.begin(), seeds.end(), [&](const terrain::Seed& seed) {
    return seed.fixed || !coupling::isTaken(ground, seed.centre, seed.radius);
  });
  counted.laying = laying.seconds();
  counted.grains = laid + whole.grains->sources.total();
  for (const coupling::PlacedGrains& p : whole.grains->onBed)
    counted.grains += static_cast<std::int64_t>(p.grains.size());
  return counted;
}

} // namespace grouser::forecast
