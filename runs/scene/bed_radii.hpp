// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "terrain/radius_distribution.hpp"

#include <fmt/format.h>

#include <string>

namespace grouser::scene {

/// Radius distribution of a random bed. Requires a [terrain] section that has been read.
inline terrain::RadiusDistribution bedRadii(const Terrain& t) {
  return {*t.radiusDistribution, *t.grainRadius, t.radiusSpread.value_or(0), t.sieveSize, t.sievePassing};
}

/// Key of [terrain] that sets the radii of the bed, for messages.
inline const char* radiiKey(const Terrain& t) { return t.sieveSize.empty() ? "grain_radius" : "sieve_size"; }

/// Key and value of the radii: "terrain.grain_radius = 0.025 m", or "the sieves of terrain.sieve_size, to 0.05 m".
inline std::string radiiText(const Terrain& t) {
  return t.sieveSize.empty() ? fmt::format("terrain.grain_radius = {:g} m", *t.grainRadius)
                             : fmt::format("the sieves of terrain.sieve_size, to {:g} m", t.sieveSize.back());
}

} // namespace grouser::scene
