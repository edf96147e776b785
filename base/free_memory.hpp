// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"

#include <optional>

namespace grouser::base {

/// Memory that this process can still allocate [B]: the minimum of the system's available memory and the remainders of
/// the cgroup (v2) limit and of `ulimit -v`. Empty if unknown.
std::optional<double> freeMemoryOfHost();

/// Free memory on the device of `exec` [B]; for a CPU, freeMemoryOfHost().
std::optional<double> freeMemoryOf(const Exec& exec);

} // namespace grouser::base
