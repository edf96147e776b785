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
  std::vector<PatchSums> sums; ///< of the last step, for the ledger only

  /// Words of the state hash: the springs.
  std::vector<std::uint32_t> words() const;
};

/// Contacts of grains with parts.
struct SavedGrainPatches {
  /// Eight words per touching patch: key (grain id << 16 | part), low word first; PatchMemory. By ascending key,
  /// patches of one key in their order. The hash takes these, the angles and the dents.
  std::vector<std::uint32_t> memories;
  std::vector<float> angles;          ///< [patches][3] rolling angle of each [rad]; empty without rolling friction
  std::vector<float> dents;           ///< [patches] of each [m]; empty where no grain crushes
  std::vector<std::int64_t> sums;     ///< of the last step and since the start (PartSum)
  std::vector<std::uint64_t> deepest; ///< [parts] grain with the largest overlap since the last row

  /// Words of the state hash: memories, angles, dents.
  std::vector<std::uint32_t> words() const;
};

} // namespace grouser::contact
