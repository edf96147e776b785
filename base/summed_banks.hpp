// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/wide_sum.cuh"

#include <cstddef>
#include <vector>

namespace grouser::base {

/// Exact sums over the banks of a kernel and over all ranks: banks[k] is a part of the sum k % count. Collective call.
std::vector<WideSum> summedBanks(const std::vector<WideSum>& banks, std::size_t count, const Comm& comm);

} // namespace grouser::base
