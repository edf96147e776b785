// SPDX-License-Identifier: BSD-3-Clause
#include "runs/grain_memory.hpp"

#include "terrain/grains.hpp"

namespace grouser::runs {

GrainMemory grainMemory(int historyWidth, int boundaries, bool ledger) {
  constexpr double kPlaces = 16; // of a list before it grows
  constexpr double kWord = sizeof(std::uint32_t), kMask = sizeof(std::uint64_t);
  GrainMemory m;
  m.state = 2 * (sizeof(base::Position) + 2 * sizeof(terrain::Vec4f)) + sizeof(terrain::Remainders) + kWord;
  // Count, slots, mask and id, twice; order, key and one cell of the grid; where the grain was at the rebuild.
  m.lists = 2 * (kWord + kPlaces * kWord + kMask + kWord) + (kWord + kMask + kWord) + 3 * kWord;
  m.history = 2 * kPlaces * historyWidth * sizeof(float);
  if (boundaries > 0) m.boundaries = 2 * kWord + boundaries * historyWidth * sizeof(float);
  if (ledger) m.ledger = sizeof(double);
  return m;
}

} // namespace grouser::runs
