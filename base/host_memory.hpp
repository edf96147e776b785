// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

/// Tracks host memory owned by arrays, for base/memory_held.hpp.
namespace grouser::base {

/// Records an allocation or an imminent deallocation; ignores null.
void noteTaken(void* memory) noexcept;
void noteGivenBack(void* memory) noexcept;

/// Current size, and peak since restartHostPeak() [B].
std::size_t heldOnHost();
std::size_t peakHostMemory();
void restartHostPeak();

} // namespace grouser::base
