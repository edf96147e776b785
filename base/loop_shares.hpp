// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace grouser::base {

/// Returns the number of threads for a CPU loop whose items cost about `nanoseconds` each: `most`, or one if the loop
/// is too short to amortise the fork and join of a team (some microseconds). Intermediate values are avoided because
/// libgomp ends the threads that a smaller team does not use and starts new ones for the next loop.
int threadsForLoop(std::int64_t count, double nanoseconds, int most);

/// memset and memcpy split over threads: each thread touches its share of the pages first, which places them on its
/// NUMA node. Loops assign the same share of their items to thread t of T.
void zeroShared(void* memory, std::size_t bytes, int threads);
void copyShared(void* to, const void* from, std::size_t bytes, int threads);

} // namespace grouser::base
