// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"

namespace grouser::base {

/// What the arrays of this process hold on a device [B].
struct MemoryHeld {
  std::size_t now;
  std::size_t most;     ///< at a time since restartMemoryPeak(); on a GPU with what sorting and scans take for a moment
  std::size_t reserved; ///< the most that the system has given for that; on the CPU `most`
};
/// Throws DeviceError where the device does not answer.
MemoryHeld memoryHeld(const Exec& exec);
void restartMemoryPeak(const Exec& exec);

} // namespace grouser::base
