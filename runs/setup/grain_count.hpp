// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <cstdint>

namespace grouser::setup {

/// Number of grains of a scene, including later and fixed floor grains; for a random bed within a few per mille. Reads
/// the height-map, since hills may require more grains.
std::int64_t plannedGrains(const scene::Scene& scene);

/// Grains of the bed of a scene that has one.
struct BedGrains {
  std::int64_t loose = 0, fixed = 0; ///< on its floor
};
BedGrains bedGrains(const scene::Scene& scene);

} // namespace grouser::setup
