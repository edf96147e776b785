// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace grouser::base {

/// All of `most` threads, or one where a loop on a CPU whose items cost one core about `nanoseconds` each does not pay
/// for them: to hand them a loop, and to hear of its end, takes some microseconds. Never some of them: libgomp ends the
/// threads that a smaller team has no use for, and starts others for the next loop.
int threadsForLoop(std::int64_t count, double nanoseconds, int most);

/// memset and memcpy by threads: each of them is the first to touch the pages of its share, which on a host with
/// several sockets then lie with it. Loops give thread t of T the same share of their items.
void zeroShared(void* memory, std::size_t bytes, int threads);
void copyShared(void* to, const void* from, std::size_t bytes, int threads);

} // namespace grouser::base
