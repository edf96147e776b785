// SPDX-License-Identifier: BSD-3-Clause
#include "runs/simulation/vehicle_state.hpp"

#include <cstring>

namespace grouser::simulation {

std::vector<std::uint32_t> VehicleState::words() const {
  std::vector<std::uint32_t> words;
  for (const std::vector<double>* part : {&bodies, &driver})
    for (const double v : *part) {
      std::uint32_t raw[2];
      std::memcpy(raw, &v, sizeof raw);
      words.insert(words.end(), raw, raw + 2);
    }
  for (const std::vector<std::uint32_t>& more : {track.words(), ground.words(), bed.memories})
    words.insert(words.end(), more.begin(), more.end());
  return words;
}

} // namespace grouser::simulation
