// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

/// Anonymous memory shared by processes of one machine; the system frees it even if the processes are killed.
namespace grouser::base {

/// Zeroed memory block of this process that other processes can map while `file` is open.
struct SharedBlock {
  void* memory{nullptr}; ///< null if memory is insufficient or the system does not support sharing
  int file{-1};
};

SharedBlock createShared(std::size_t bytes) noexcept;
/// Maps the block of another process, given its process and file numbers. Returns null if no block of this size exists
/// or access is denied.
void* openShared(int process, int file, std::size_t bytes) noexcept;
/// Prevents further processes from mapping the block; existing mappings remain valid.
void endSharing(SharedBlock& block) noexcept;
void closeShared(void* memory, std::size_t bytes) noexcept;

} // namespace grouser::base
