// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

/// What arrays hold in the memory of the host, counted for base/memory_held.hpp.
namespace grouser::base {

/// Memory that has been taken, or is about to be given back; null does nothing.
void noteTaken(void* memory) noexcept;
void noteGivenBack(void* memory) noexcept;

/// [B], and the most at a time since restartHostPeak().
std::size_t heldOnHost();
std::size_t mostHeldOnHost();
void restartHostPeak();

} // namespace grouser::base
