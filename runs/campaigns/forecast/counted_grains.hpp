// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <cstdint>
#include <string>

namespace grouser::forecast {

/// Number of grains of a run, and its accuracy.
struct CountedGrains {
  std::int64_t grains = 0; ///< including later sources and fixed floor grains
  bool exact = true;       ///< counted as a run places them
  std::string doubt;       ///< reason why the count is not exact; else empty
  double laying = 0;       ///< time to lay the bed [s]; 0 if not laid
};

/// Largest bed that is laid to count its grains; larger ones are estimated by volume.
inline constexpr std::int64_t kMostLaid = 1'000'000;

/// Lays the bed of the scene around obstacles, as a run does, and counts its grains. Reads the height-map. A bed of
/// more than `mostLaid` grains, or of copied tiles, is not laid; `doubt` then has the uncertainty. Throws as
/// groundSetup().
CountedGrains countGrains(const scene::Scene& scene, double timeStep, std::int64_t mostLaid = kMostLaid);

} // namespace grouser::forecast
