// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace grouser::base {

/// As many of `most` threads as a loop on a CPU pays for whose items cost one core about `nanoseconds` each: a few
/// microseconds of work for each of them, for so long takes it to hand them a loop and to hear of its end.
int threadsForLoop(std::int64_t count, double nanoseconds, int most);

/// memset and memcpy by threads: each of them is the first to touch the pages of its share, which on a host with
/// several sockets then lie with it. Loops give thread t of T the same share of their items.
void zeroShared(void* memory, std::size_t bytes, int threads);
void copyShared(void* to, const void* from, std::size_t bytes, int threads);

} // namespace grouser::base
