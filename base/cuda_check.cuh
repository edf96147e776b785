// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"

#include <cuda_runtime.h>
#include <string>

namespace grouser::base {

/// Throws DeviceError with `code` unless it reports success; `what` names the failed call.
inline void checkCuda(cudaError_t code, const std::string& what) {
  if (code != cudaSuccess)
    throw DeviceError(what + ": " + cudaGetErrorName(code) + " (" + cudaGetErrorString(code) + ")");
}

} // namespace grouser::base
