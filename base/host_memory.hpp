// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

/// Host memory held by arrays, counted for base/memory_held.hpp.
namespace grouser::base {

/// Reports memory as allocated or about to be freed; null is ignored.
void noteTaken(void* memory) noexcept;
void noteGivenBack(void* memory) noexcept;

/// Current size, and peak since restartHostPeak() [B].
std::size_t heldOnHost();
std::size_t mostHeldOnHost();
void restartHostPeak();

} // namespace grouser::base
