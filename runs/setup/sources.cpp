// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/sources.hpp"

#include "runs/scene/scene.hpp"
#include "runs/setup/grain_kinds.hpp"
#include "runs/setup/periodic_boundaries.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::setup {

coupling::Sources sourcesOf(const scene::Scene& scene, const GrainKinds& kinds, double timeStep) {
  std::vector<coupling::SourceSetup> sources;
  for (std::size_t k = 0; k < scene.sources.size(); ++k) {
    const scene::Source& s = scene.sources[k];
    coupling::SourceSetup source;
    source.place = scene.placeOf("source", k);
    source.low = s.low, source.high = s.high, source.velocity = s.velocity, source.spin = s.spin;
    source.radius = s.radius, source.material = kinds.indexOf(s.material);
    source.number = s.number, source.total = s.total;
    source.every = std::max<std::int64_t>(1, std::llround(s.every / timeStep));
    source.first = std::llround(s.start / timeStep);
    const std::int64_t batches = (s.total + s.number - 1) / s.number;
    source.last = source.first + (batches - 1) * source.every;
    source.seed = coupling::sourceSeed(static_cast<std::uint64_t>(scene.run.seed), static_cast<std::uint64_t>(k));
    sources.push_back(std::move(source));
  }
  return {std::move(sources), periodicBoundaries(scene)};
}

void checkSources(const scene::Scene& scene, const GrainKinds& kinds) {
  constexpr double kAllAtOnce = 1e300; // a time step [s] so long that all sources start in the first step
  sourcesOf(scene, kinds, kAllAtOnce).enteringAt(0);
}

} // namespace grouser::setup
