// SPDX-License-Identifier: BSD-3-Clause
#include "runs/simulation/vehicle_state.hpp"

#include "multibody/state.hpp"

#include <cstring>

namespace grouser::simulation {

std::vector<std::uint32_t> VehicleState::words() const {
  std::vector<std::uint32_t> words;
  const auto add = [&](const std::vector<double>& numbers, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      std::uint32_t raw[2];
      std::memcpy(raw, &numbers[i], sizeof raw);
      words.insert(words.end(), raw, raw + 2);
    }
  };
  add(bodies, bodies.empty() ? 0 : bodies.size() - multibody::State::kBooks);
  add(driver, driver.size());
  for (const std::vector<std::uint32_t>& more : {track.words(), ground.words(), bed.words()})
    words.insert(words.end(), more.begin(), more.end());
  return words;
}

} // namespace grouser::simulation
