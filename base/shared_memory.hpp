// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

/// Memory shared by processes of one machine. It has no name, so nothing remains however a process ends.
namespace grouser::base {

/// A block of memory of this process, zeroed, that others can map while `file` is open.
struct SharedBlock {
  void* memory{nullptr}; ///< null if there is not enough memory, or the system does not support it
  int file{-1};
};

SharedBlock createShared(std::size_t bytes) noexcept;
/// Maps the block of another process, given its process and file numbers; null if there is none of this size, or access
/// is denied.
void* openShared(int process, int file, std::size_t bytes) noexcept;
/// No further process can map the block; those that have mapped it keep it.
void endSharing(SharedBlock& block) noexcept;
void closeShared(void* memory, std::size_t bytes) noexcept;

} // namespace grouser::base
