// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

/// Memory that processes of one machine share under a name (POSIX shared memory).
namespace grouser::base {

/// A new block under a name that is not in use, zeroed; null where there is no room for all of it.
void* createShared(const std::string& name, std::size_t bytes) noexcept;
/// The block of another process under its name; null where there is none of this size.
void* openShared(const std::string& name, std::size_t bytes) noexcept;
/// Unlinks the name: no process can open the block any more; those that have mapped it keep it.
void forgetShared(const std::string& name) noexcept;
void closeShared(void* memory, std::size_t bytes) noexcept;

} // namespace grouser::base
