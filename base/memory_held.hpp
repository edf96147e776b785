// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"

namespace grouser::base {

/// Device memory held by the arrays of this process [B].
struct MemoryHeld {
  std::size_t now;
  std::size_t most;     ///< peak since restartMemoryPeak(); on a GPU with the temporary memory of sorts and scans
  std::size_t reserved; ///< peak reserved from the system; on the CPU `most`
};
/// Throws DeviceError where the device does not answer.
MemoryHeld memoryHeld(const Exec& exec);
void restartMemoryPeak(const Exec& exec);

} // namespace grouser::base
