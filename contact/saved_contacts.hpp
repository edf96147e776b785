// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/patch_law.hpp"

#include <cstdint>
#include <vector>

/// Contact history in checkpoints. Neighbour lists are not stored; they are rebuilt.
namespace grouser::contact {

/// Contacts of extended surfaces, by pair and cluster.
struct SavedPatches {
  std::vector<PatchState> states;
  std::vector<PatchSums> sums; ///< sums of the last step, only for the ledger

  /// Words of the state hash: the tangential springs.
  std::vector<std::uint32_t> words() const;
};

/// Contacts of grains with parts.
struct SavedGrainPatches {
  /// Eight words per touching patch: key (grain id << 16 | part), low word first; PatchMemory. Sorted by key; patches
  /// with equal keys keep their order. The hash covers these, the angles and the dents.
  std::vector<std::uint32_t> memories;
  std::vector<float> angles;          ///< [patches][3] rolling angles [rad]; empty without rolling friction
  std::vector<float> dents;           ///< [patches] dents [m]; empty if no grain crushes
  std::vector<std::int64_t> sums;     ///< sums of the last step and cumulative sums (PartSum)
  std::vector<std::uint64_t> deepest; ///< [parts] grain with the largest overlap since the last output row

  /// Words of the state hash: memories, angles, dents.
  std::vector<std::uint32_t> words() const;
};

} // namespace grouser::contact
