// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace grouser::base {

/// Number of threads for a CPU loop whose items cost about `nanoseconds` each: all of `most`, or one if the loop is too
/// short for the start and join of a team (some microseconds). Never fewer than all: libgomp ends the threads that a
/// smaller team does not use, and starts new ones for the next loop.
int threadsForLoop(std::int64_t count, double nanoseconds, int most);

/// memset and memcpy by threads: each of them is the first to touch the pages of its share, which on a host with
/// several sockets then lie with it. Loops give thread t of T the same share of their items.
void zeroShared(void* memory, std::size_t bytes, int threads);
void copyShared(void* to, const void* from, std::size_t bytes, int threads);

} // namespace grouser::base
