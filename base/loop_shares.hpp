// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace grouser::base {

/// Returns the number of threads for a CPU loop whose items cost about `nanoseconds` each: `most`, or one if the loop
/// is too short to amortise the fork and join of a team (some microseconds). Intermediate numbers are not used: for a
/// smaller team, libgomp ends the unused threads and starts new threads for the next loop.
int threadsForLoop(std::int64_t count, double nanoseconds, int most);

/// memset and memcpy split over threads: each thread is the first to touch its share of the pages, which places them on
/// its NUMA node. In loops, thread t of T processes the corresponding share of the items.
void zeroShared(void* memory, std::size_t bytes, int threads);
void copyShared(void* to, const void* from, std::size_t bytes, int threads);

} // namespace grouser::base
