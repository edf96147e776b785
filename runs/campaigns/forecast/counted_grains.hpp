// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <cstdint>
#include <string>

namespace grouser::forecast {

/// How many grains a run of a scene will have, and how sure that is.
struct CountedGrains {
  std::int64_t grains = 0; ///< those that enter later and fixed ones of the floor among them
  bool exact = true;       ///< laid, or placed one by one, as a run does it
  std::string doubt;       ///< why it is not exact, in words; empty where it is
  double laying = 0;       ///< how long laying the bed took [s]; 0 where none was laid
};

/// A bed up to which grains are laid to count them; of larger ones the volume tells.
inline constexpr std::int64_t kMostLaid = 1'000'000;

/// Lays the bed of the scene, around what stands in it, as a run does, and counts. Reads the height-map. A bed of more
/// than `mostLaid` grains, or of copied tiles, is not laid: then `doubt` says how far off its count may be. Throws what
/// groundSetup() throws.
CountedGrains countGrains(const scene::Scene& scene, double timeStep, std::int64_t mostLaid = kMostLaid);

} // namespace grouser::forecast
