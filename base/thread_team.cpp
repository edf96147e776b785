// SPDX-License-Identifier: BSD-3-Clause
#include "base/thread_team.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <memory>
#include <pthread.h>
#include <system_error>
#include <thread>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace grouser::base {

namespace {

// Handing a loop to a thread that is awake, and hearing of its end, takes about a microsecond; waking one five to
// fifty.
constexpr double kLeastShare = 4e3;   // [ns] of work that a thread is called for
constexpr double kWorthWaking = 50e3; // [ns] of a loop for which sleeping threads are woken
constexpr double kLeastChunk = 2e3;   // [ns] beside which the taking of a chunk is nothing
constexpr double kMostChunk = 20e3;   // [ns] that the end of a loop may have to wait for
constexpr int kChunksEach = 8;        // of a thread in a loop, where items are small enough
constexpr int kMostThreads = 1024;
constexpr std::size_t kLeastShared = std::size_t{1} << 19; // [bytes] that are worth several threads
constexpr std::size_t kPage = 4096;                        // [bytes]
constexpr double kNanosecondsPerPage = 400;

using Clock = std::chrono::steady_clock;
/// Looks for the next loop before a thread sleeps, a few milliseconds of its own: longer than the host's work between
/// the loops of a step. Counted, not timed: one whose core is taken meanwhile shall find its way to another.
constexpr int kLooks = 50000;
constexpr auto kPatience = std::chrono::microseconds(20);

void pause() {
#if defined(__x86_64__)
  _mm_pause();
#endif
}

/// Threads of this process, made when first needed; they live as long as it does.
class ThreadTeam {
public:
  /// Null in a forked child, which has none of the threads.
  static ThreadTeam* instance() {
    static ThreadTeam* const team = new ThreadTeam; // never destroyed: its threads look at it to the end
    return orphaned().load(std::memory_order_relaxed) ? nullptr : team;
  }

  /// Returns false, with nothing done, where another loop has the team.
  bool run(const SharedLoop& loop, const LoopShares& shares) {
    if (busy_.exchange(true, std::memory_order_acquire)) return false;
    grow(shares.threads - 1);
    const int threads = std::min(shares.threads, workers_ + 1);
    const std::int64_t chunks = (loop.count + shares.chunk - 1) / shares.chunk;
    loop_ = loop, chunk_ = shares.chunk;
    done_.store(0, std::memory_order_relaxed);
    helpers_.store(loop.ownSharesOnly ? 0 : threads, std::memory_order_relaxed);
    for (int t = 0; t < threads; ++t)
      shares_[t].range.store(packed(chunks * t / threads, chunks * (t + 1) / threads), std::memory_order_release);
    generation_.fetch_add(1, std::memory_order_seq_cst);
    const bool wake = loop.ownSharesOnly || static_cast<double>(loop.count) * loop.nanoseconds >= kWorthWaking;
    if (wake && sleepers_.load(std::memory_order_seq_cst) > 0) generation_.notify_all();
    takeChunks(0);
    awaitEnd(chunks);
    busy_.store(false, std::memory_order_release);
    return true;
  }

private:
  /// Chunks of one thread that nobody has taken yet: the next, and the end. A line of the cache each.
  struct alignas(64) Share {
    std::atomic<std::uint64_t> range{0};
  };

  ThreadTeam() {
    pthread_atfork(nullptr, nullptr, [] { orphaned().store(true, std::memory_order_relaxed); });
  }

  static std::atomic<bool>& orphaned() {
    static std::atomic<bool> alone{false};
    return alone;
  }

  static std::uint64_t packed(std::int64_t next, std::int64_t end) {
    return static_cast<std::uint64_t>(next) << 32 | static_cast<std::uint64_t>(end);
  }

  void grow(int workers) {
    try {
      for (; workers_ < std::min(workers, kMostThreads - 1); ++workers_)
        std::thread(&ThreadTeam::work, this, workers_ + 1, generation_.load()).detach();
    } catch (const std::system_error&) {
      // As many as the system gives.
    }
  }

  void work(int self, std::uint32_t seen) {
    for (;;) {
      awaitLoop(seen);
      seen = generation_.load(std::memory_order_acquire);
      takeChunks(self);
    }
  }

  void awaitLoop(std::uint32_t seen) {
    for (int k = 0; k < kLooks; ++k) {
      if (generation_.load(std::memory_order_acquire) != seen) return;
      pause();
    }
    sleepers_.fetch_add(1, std::memory_order_seq_cst);
    generation_.wait(seen, std::memory_order_seq_cst);
    sleepers_.fetch_sub(1, std::memory_order_relaxed);
  }

  /// Those of the own share from its start, then those of others from their ends.
  void takeChunks(int self) {
    while (takeOne(shares_[self], true)) {}
    const int threads = helpers_.load(std::memory_order_relaxed);
    for (int k = 1; self < threads && k < threads; ++k)
      while (takeOne(shares_[(self + k) % threads], false)) {}
  }

  /// A chunk that has been taken belongs to the loop under way, whichever that is by now: it cannot end before.
  bool takeOne(Share& share, bool first) {
    std::uint64_t range = share.range.load(std::memory_order_relaxed);
    for (;;) {
      const std::uint64_t next = range >> 32, end = range & 0xFFFFFFFFu;
      if (next >= end) return false;
      const std::uint64_t left = first ? range + (std::uint64_t{1} << 32) : range - 1;
      if (!share.range.compare_exchange_weak(range, left, std::memory_order_acq_rel, std::memory_order_relaxed))
        continue;
      const std::int64_t start = static_cast<std::int64_t>(first ? next : end - 1) * chunk_;
      loop_.run(loop_.body, start, std::min(start + chunk_, loop_.count));
      done_.fetch_add(1, std::memory_order_release);
      return true;
    }
  }

  void awaitEnd(std::int64_t chunks) {
    const auto ended = [&] { return done_.load(std::memory_order_acquire) == chunks; };
    if (ended()) return;
    const auto until = Clock::now() + kPatience;
    while (!ended())
      if (Clock::now() < until)
        pause();
      else
        std::this_thread::yield(); // who is late may need this core
  }

  std::atomic<bool> busy_{false};
  int workers_{0};
  SharedLoop loop_{};
  std::int64_t chunk_{1};
  std::unique_ptr<Share[]> shares_{new Share[kMostThreads]};
  alignas(64) std::atomic<std::uint32_t> generation_{0};
  std::atomic<int> sleepers_{0}, helpers_{0};
  alignas(64) std::atomic<std::int64_t> done_{0};
};

struct CopyPages {
  void* to;
  const void* from; ///< null: zeros
  std::size_t bytes;

  static void run(const void* self, std::int64_t first, std::int64_t last) {
    const CopyPages& c = *static_cast<const CopyPages*>(self);
    const std::size_t start = static_cast<std::size_t>(first) * kPage;
    const std::size_t size = std::min(static_cast<std::size_t>(last) * kPage, c.bytes) - start;
    if (c.from)
      std::memcpy(static_cast<char*>(c.to) + start, static_cast<const char*>(c.from) + start, size);
    else
      std::memset(static_cast<char*>(c.to) + start, 0, size);
  }
};

void runPages(const CopyPages& pages, int threads) {
  const auto count = static_cast<std::int64_t>((pages.bytes + kPage - 1) / kPage);
  if (threads <= 1 || pages.bytes < kLeastShared) return CopyPages::run(&pages, 0, count);
  const bool firstTouch = pages.from == nullptr;
  runShared({CopyPages::run, &pages, count, kNanosecondsPerPage, firstTouch},
            {threads, (count + threads - 1) / threads});
}

} // namespace

LoopShares sharesOfLoop(std::int64_t count, double nanoseconds, int most) {
  const double all = static_cast<double>(count) * nanoseconds;
  LoopShares shares;
  shares.threads = static_cast<int>(std::min({static_cast<double>(most), all / kLeastShare, 1.0 * kMostThreads}));
  shares.threads = static_cast<int>(std::max<std::int64_t>(1, std::min<std::int64_t>(shares.threads, count)));
  const double chunk = std::clamp(all / (kChunksEach * shares.threads), kLeastChunk, kMostChunk) / nanoseconds;
  shares.chunk = std::clamp<std::int64_t>(static_cast<std::int64_t>(chunk), 1, std::max<std::int64_t>(1, count));
  return shares;
}

void runShared(const SharedLoop& loop, const LoopShares& shares) {
  if (loop.count <= 0) return;
  if (shares.threads > 1)
    if (ThreadTeam* const team = ThreadTeam::instance(); team && team->run(loop, shares)) return;
  loop.run(loop.body, 0, loop.count);
}

void zeroShared(void* memory, std::size_t bytes, int threads) { runPages({memory, nullptr, bytes}, threads); }

void copyShared(void* to, const void* from, std::size_t bytes, int threads) { runPages({to, from, bytes}, threads); }

} // namespace grouser::base
