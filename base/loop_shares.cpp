// SPDX-License-Identifier: BSD-3-Clause
#include "base/loop_shares.hpp"

#include <algorithm>
#include <cstring>

namespace grouser::base {

namespace {

// Minimum work for a team of threads [ns], above the cost of starting and joining a parallel loop.
constexpr double kMinOfTeam = 4e3, kMinOfThread = 250;
constexpr std::size_t kMinShared = std::size_t{1} << 19; // [bytes] minimum size for several threads
constexpr std::size_t kPage = 4096;                      // [bytes]

/// Calls work(first byte, number of bytes) for shares of whole pages.
template <class Work> void share(std::size_t bytes, int threads, const Work& work) {
  if (threads <= 1 || bytes < kMinShared) return work(0, bytes);
  const std::size_t pages = (bytes + kPage - 1) / kPage, shares = static_cast<std::size_t>(threads);
#pragma omp parallel for schedule(static, 1) num_threads(threads)
  for (std::size_t t = 0; t < shares; ++t) {
    const std::size_t first = pages * t / shares * kPage;
    work(first, std::min(pages * (t + 1) / shares * kPage, bytes) - first);
  }
}

} // namespace

int threadsForLoop(std::int64_t count, double nanoseconds, int most) {
  if (most < 2 || count < 2) return 1;
  return static_cast<double>(count) * nanoseconds < kMinOfTeam + kMinOfThread * most ? 1 : most;
}

void zeroShared(void* memory, std::size_t bytes, int threads) {
  share(bytes, threads,
        [memory](std::size_t first, std::size_t count) { std::memset(static_cast<char*>(memory) + first, 0, count); });
}

void copyShared(void* to, const void* from, std::size_t bytes, int threads) {
  share(bytes, threads, [to, from](std::size_t first, std::size_t count) {
    std::memcpy(static_cast<char*>(to) + first, static_cast<const char*>(from) + first, count);
  });
}

} // namespace grouser::base
