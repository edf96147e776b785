// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"

#include <optional>

namespace grouser::base {

/// Memory that this process may still take [B]: the least of what the system calls available, what the limit of its
/// group (cgroup v2) leaves, and what `ulimit -v` leaves. Empty where the system does not tell.
std::optional<double> freeMemoryOfHost();

/// Memory that is free on the device of `exec`, whoever took the rest [B]; on a CPU as freeMemoryOfHost().
std::optional<double> freeMemoryOf(const Exec& exec);

} // namespace grouser::base
