// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

/// Memory that processes of one machine share under a name (POSIX shared memory).
namespace grouser::base {

/// A fresh block under a name that nobody has, zeroed; null where there is no room for all of it.
void* createShared(const std::string& name, std::size_t bytes) noexcept;
/// The block of another process under its name; null where there is none of this size.
void* openShared(const std::string& name, std::size_t bytes) noexcept;
/// Nobody can open it any more; who has it, keeps it.
void forgetShared(const std::string& name) noexcept;
void closeShared(void* memory, std::size_t bytes) noexcept;

} // namespace grouser::base
