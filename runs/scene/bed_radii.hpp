// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "terrain/radius_distribution.hpp"

namespace grouser::scene {

/// The radii of a random bed, whose section has been read.
inline terrain::RadiusDistribution bedRadii(const Terrain& t) {
  return {*t.radiusDistribution, *t.grainRadius, t.radiusSpread.value_or(0), t.sieveSize, t.sievePassing};
}

} // namespace grouser::scene
