// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"

#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// State and ledger sums of grains, bit by bit.
inline std::vector<std::uint32_t> wordsOf(const Grains& grains) {
  const GrainState state = grains.state();
  std::vector<std::uint32_t> words = state.words();
  for (const std::int64_t sum : state.ledgerSums)
    words.push_back(static_cast<std::uint32_t>(sum)), words.push_back(static_cast<std::uint32_t>(sum >> 32));
  return words;
}

} // namespace grouser::terrain
