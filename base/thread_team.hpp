// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace grouser::base {

/// How a loop on a CPU is cut up.
struct LoopShares {
  int threads{1};        ///< that take part, the caller among them
  std::int64_t chunk{1}; ///< items that a thread takes at once
};

/// As many of `most` threads as a loop pays for whose items cost one core about `nanoseconds` each, and chunks that are
/// small beside a thread's share, so that one who is late is helped.
LoopShares sharesOfLoop(std::int64_t count, double nanoseconds, int most);

/// A loop that threads share: `run(body, first, last)` does items first .. last - 1.
struct SharedLoop {
  void (*run)(const void* body, std::int64_t first, std::int64_t last);
  const void* body;
  std::int64_t count;
  double nanoseconds; ///< of one item, about
  /// Each thread does its own share, as for the first touch of memory; else who has ended takes from others' shares.
  bool ownSharesOnly{false};
};

/// Runs `loop` on the calling thread and threads of the team, and returns when all of it is done. Thread t of T has the
/// same part of [0, count) in every loop, so that a core meets its own memory again. The caller waits for a thread only
/// while that thread is at work on a chunk: one that sleeps, or whose core is taken by another program, holds up
/// nothing. Within a loop, beside another loop, and in a forked child the caller does all of it.
void runShared(const SharedLoop& loop, const LoopShares& shares);

/// memset and memcpy by the threads of the team: each of them is the first to touch the pages of its share, which on a
/// host with several sockets then lie with it.
void zeroShared(void* memory, std::size_t bytes, int threads);
void copyShared(void* to, const void* from, std::size_t bytes, int threads);

} // namespace grouser::base
