// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "terrain/radius_distribution.hpp"

#include <fmt/format.h>

#include <string>

namespace grouser::scene {

/// The radii of a random bed, whose section has been read.
inline terrain::RadiusDistribution bedRadii(const Terrain& t) {
  return {*t.radiusDistribution, *t.grainRadius, t.radiusSpread.value_or(0), t.sieveSize, t.sievePassing};
}

/// The key of a bed's radii, for messages.
inline const char* radiiKey(const Terrain& t) { return t.sieveSize.empty() ? "grain_radius" : "sieve_size"; }

/// Its value as text: "terrain.grain_radius = 0.025 m", or "the sieves of terrain.sieve_size, to 0.05 m".
inline std::string radiiText(const Terrain& t) {
  return t.sieveSize.empty() ? fmt::format("terrain.grain_radius = {:g} m", *t.grainRadius)
                             : fmt::format("the sieves of terrain.sieve_size, to {:g} m", t.sieveSize.back());
}

} // namespace grouser::scene
