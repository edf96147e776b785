// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"

namespace grouser::base {

/// Device memory owned by the arrays of this process [B].
struct MemoryHeld {
  std::size_t now;
  std::size_t most;     ///< peak since restartMemoryPeak(); on a GPU including temporary memory of sorts and scans
  std::size_t reserved; ///< peak reserved from the system; on the CPU equal to `most`
};
/// Returns the current counts. Throws DeviceError if the device does not respond.
MemoryHeld memoryHeld(const Exec& exec);
void restartMemoryPeak(const Exec& exec);

} // namespace grouser::base
