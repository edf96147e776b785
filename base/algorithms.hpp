// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"

#include <cstdint>

/// Parallel primitives on arrays in the memory of `exec`, built on Thrust. All values are integers, so the result does
/// not depend on the order of operations.
namespace grouser::base {

/// Stable sort of `values` by `keys`, both of length `count`, in place.
void sortByKey(const Exec& exec, std::uint64_t* keys, std::uint32_t* values, std::size_t count);
/// out[i] = in[0] + ... + in[i-1]; `out` may be `in`. Returns the total.
std::uint32_t exclusiveScan(const Exec& exec, const std::uint32_t* in, std::uint32_t* out, std::size_t count);
/// Returns the sum of the elements, accumulated in 64 bits.
std::uint64_t sum(const Exec& exec, const std::uint32_t* values, std::size_t count);
/// Returns the largest element; 0 for an empty range.
std::uint32_t maximum(const Exec& exec, const std::uint32_t* values, std::size_t count);
/// Writes the indices of all nonzero marks to `list`, in ascending order.
void listMarked(const Exec& exec, const std::uint32_t* marks, std::size_t count, Array<std::uint32_t>& list);
/// out[i] = i.
void iota(const Exec& exec, std::uint32_t* out, std::size_t count);

} // namespace grouser::base
