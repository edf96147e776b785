// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

/// Memory that processes of one machine share. It has no name: however a process ends, nothing of it stays behind.
namespace grouser::base {

/// A block of memory of this process, zeroed, that others can map while `file` is open.
struct SharedBlock {
  void* memory{nullptr}; ///< null where there is no room for all of it, or the system has no such memory
  int file{-1};
};

SharedBlock createShared(std::size_t bytes) noexcept;
/// The block of another process, which tells its own number and that of its open file; null where there is none of
/// this size, or where this process may not look there.
void* openShared(int process, int file, std::size_t bytes) noexcept;
/// No further process can map the block; those that have mapped it keep it.
void endSharing(SharedBlock& block) noexcept;
void closeShared(void* memory, std::size_t bytes) noexcept;

} // namespace grouser::base
