// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <cstdint>
#include <string>

namespace grouser::forecast {

/// Number of grains of a run, and the accuracy of this number.
struct CountedGrains {
  std::int64_t grains = 0; ///< includes fixed floor grains and grains from sources
  bool exact = true;       ///< true: counted by laying the bed as in a run
  std::string doubt;       ///< reason why the count is not exact; else empty
  double laying = 0;       ///< time to lay the bed [s]; 0 if not laid
};

/// Maximum number of grains of a bed that is laid to count them; larger beds are estimated from the volume.
inline constexpr std::int64_t kMaxLaid = 1'000'000;

/// Lays the bed of the scene around obstacles, as a run does, and counts its grains. Reads the height-map. Does not lay
/// a bed of copied tiles or of more than `maxLaid` grains; `doubt` then states the uncertainty. Throws the errors of
/// groundSetup().
CountedGrains countGrains(const scene::Scene& scene, double timeStep, std::int64_t maxLaid = kMaxLaid);

} // namespace grouser::forecast
