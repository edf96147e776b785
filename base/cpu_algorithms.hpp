// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"

#include <cstddef>
#include <cstdint>

/// What base/algorithms.hpp promises, by the threads of a CPU: blocks of items are counted side by side, then placed.
namespace grouser::base::cpu {

void sortByKey(const Exec& exec, std::uint64_t* keys, std::uint32_t* values, std::size_t count);
std::uint32_t exclusiveScan(const Exec& exec, const std::uint32_t* in, std::uint32_t* out, std::size_t count);
std::uint32_t maximum(const Exec& exec, const std::uint32_t* values, std::size_t count);
/// Into `list`, which has room for all; returns how many.
std::size_t listMarked(const Exec& exec, const std::uint32_t* marks, std::size_t count, std::uint32_t* list);
void iota(const Exec& exec, std::uint32_t* out, std::size_t count);

} // namespace grouser::base::cpu
