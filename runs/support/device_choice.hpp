// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/exec.hpp"

#include <string>

namespace grouser::support {

/// Where to compute: `device` is auto (the GPU where there is one), cpu or cuda; `threads` 0 takes all cores. Ranks of
/// one host take its GPUs in turn and share its cores. Throws InputError for another word, DeviceError where there is
/// no such device.
base::Exec chooseDevice(const std::string& device, int threads, const base::Ranks* ranks);

} // namespace grouser::support
