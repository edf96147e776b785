// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/vehicle_state.hpp"

#include "contact/part_surface.hpp"
#include "multibody/state.hpp"
#include "vehicle/assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

namespace grouser::coupling {

std::vector<std::uint32_t> VehicleState::words() const {
  std::vector<std::uint32_t> words;
  addWords(words, bodies.data(), bodies.empty() ? 0 : bodies.size() - multibody::State::kBooks);
  addWords(words, driver.data(), driver.size());
  addWords(words, hitch.data(), hitch.size());
  const std::vector<std::uint32_t> touching = contacts.words();
  words.insert(words.end(), touching.begin(), touching.end());
  return words;
}

std::string mostDissipatingPart(const vehicle::Assembly& assembly, const VehicleState& state) {
  std::map<std::string, double> by;
  for (std::size_t k = 0; k < state.contacts.track.states.size(); ++k) {
    const vehicle::PartPair& pair = assembly.pairs[k / static_cast<std::size_t>(contact::kClusters)];
    by[assembly.parts[static_cast<std::size_t>(pair.other)].name] += state.contacts.track.states[k].dissipated;
  }
  for (const contact::PatchState& patch : state.contacts.ground.states) by["ground"] += patch.dissipated;
  for (const contact::PatchState& patch : state.contacts.surfaces.states) by["obstacles and hull"] += patch.dissipated;
  std::vector<std::pair<double, std::string>> most;
  for (const auto& [name, energy] : by) most.emplace_back(energy, name);
  std::sort(most.begin(), most.end(), std::greater<>());
  constexpr std::size_t kNamed = 3;
  std::string words;
  for (std::size_t k = 0; k < std::min(kNamed, most.size()); ++k)
    words += fmt::format("{}{} {:.3g} J", k > 0 ? ", " : "", most[k].second, most[k].first);
  return words;
}

} // namespace grouser::coupling
