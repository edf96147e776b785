// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/contacts_state.hpp"

#include <cstring>
#include <iterator>

namespace grouser::coupling {

void addWords(std::vector<std::uint32_t>& words, const double* numbers, std::size_t count) {
  const std::size_t from = words.size();
  words.resize(from + 2 * count);
  if (count > 0) std::memcpy(&words[from], numbers, count * sizeof(double));
}

std::vector<std::uint32_t> ContactsState::words() const {
  std::vector<std::uint32_t> words;
  for (const std::vector<std::uint32_t>& more : {track.words(), ground.words(), bed.words()})
    words.insert(words.end(), more.begin(), more.end());
  // Include only patches in contact; other patches are not part of the state.
  for (std::size_t k = 0; k < surfaces.states.size(); ++k) {
    const contact::PatchState& s = surfaces.states[k];
    if (s.stiffness == 0) continue;
    words.push_back(static_cast<std::uint32_t>(k));
    const double numbers[] = {s.shear.x, s.shear.y, s.shear.z, s.stiffness};
    addWords(words, numbers, std::size(numbers));
  }
  return words;
}

} // namespace grouser::coupling
