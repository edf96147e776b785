// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/patch_law.hpp"

#include <cstdint>
#include <vector>

/// History of contacts, as a checkpoint holds it. Lists are left out: they can be built anew.
namespace grouser::contact {

/// Contacts of extended surfaces, by pair and cluster.
struct SavedPatches {
  std::vector<PatchState> states;
  std::vector<PatchSums> sums; ///< of the last step: only the ledger reads them again

  /// For the hash: the springs.
  std::vector<std::uint32_t> words() const;
};

/// Contacts of grains with parts.
struct SavedGrainPatches {
  /// Eight words a patch in touch: key (grain id << 16 | part), low word first; PatchMemory. By ascending key, patches
  /// of one key in their order. The hash takes these and the angles.
  std::vector<std::uint32_t> memories;
  std::vector<float> angles;      ///< [patches][3] rolling angle of each [rad]; empty without rolling friction
  std::vector<std::int64_t> sums; ///< of the last step and since the start, as GrainPartContacts keeps them

  /// For the hash: memories, then angles.
  std::vector<std::uint32_t> words() const;
};

} // namespace grouser::contact
