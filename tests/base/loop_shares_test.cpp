// SPDX-License-Identifier: BSD-3-Clause
// Loops on a CPU: distributed by cost, each item once, for any number of threads.
#include "base/for_each_group.cuh"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <atomic>
#include <vector>

namespace grouser::base {
namespace {

/// Number of threads.
struct CountThreads {
  double cost; // [ns] cost per item of the loop
  std::atomic<int>* most;
  double nanoseconds() const { return cost; }
  void operator()(int) const { *most = std::max(most->load(), omp_get_num_threads()); }
  template <class Group> void operator()(int i, const Group&) const { (*this)(i); }
};

int threadsOf(int items, double cost, int threads, bool groups = false) {
  std::atomic<int> most{0};
  const CountThreads body{cost, &most};
  if (groups)
    forEachGroup<8>(cpuExec(threads), "count threads", items, body);
  else
    forEach(cpuExec(threads), "count threads", items, body);
  return most;
}

TEST(LoopShares, FortyBlocksOfGrainsAreSharedAndAHundredCheapItemsAreNot) {
  for (const bool groups : {false, true}) {
    EXPECT_EQ(threadsOf(40, 60.0 * 256, 2, groups), 2);
    EXPECT_EQ(threadsOf(2, 60.0 * 256, 2, groups), 2);
    EXPECT_EQ(threadsOf(100, 5, 8, groups), 1);
    EXPECT_EQ(threadsOf(40, 60.0 * 256, 1, groups), 1);
  }
}

TEST(LoopShares, AllThreadsOrOne) {
  EXPECT_EQ(threadsForLoop(40, 60.0 * 256, 16), 16);
  EXPECT_EQ(threadsForLoop(3, 1e6, 16), 16) << "a smaller team would release its threads";
  EXPECT_EQ(threadsForLoop(1, 1e9, 16), 1);
  EXPECT_EQ(threadsForLoop(0, 5, 16), 1);
  EXPECT_EQ(threadsForLoop(1000, 5, 2), 2) << "5 us";
  EXPECT_EQ(threadsForLoop(1000, 5, 16), 1) << "5 us, and 16 threads to start";
  EXPECT_EQ(threadsForLoop(2000, 5, 16), 16);
}

struct CountItem {
  static constexpr double kNanoseconds = 1000;
  std::uint32_t* times;
  void operator()(int i) const { atomicAdd32(times + i, 1); }
  template <class Group> void operator()(int i, const Group&) const { (*this)(i); }
};

TEST(LoopShares, EachItemIsDoneOnceByAnyNumberOfThreads) {
  for (const int threads : {1, 2, 3, 8, 40})
    for (const int items : {1, 2, 63, 64, 1000, 4099}) {
      std::vector<std::uint32_t> times(static_cast<std::size_t>(items));
      forEach(cpuExec(threads), "count", items, CountItem{times.data()});
      forEachGroup<8>(cpuExec(threads), "count", items, CountItem{times.data()});
      EXPECT_EQ(times, std::vector<std::uint32_t>(times.size(), 2)) << items << " items, " << threads << " threads";
    }
}

TEST(LoopShares, MemoryIsZeroedAndCopiedToItsLastByte) {
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{4097}, (std::size_t{3} << 20) + 17})
    for (const int threads : {1, 2, 3, 8}) {
      std::vector<char> from(bytes + 1, 'x'), to(bytes + 1, 'y');
      copyShared(to.data(), from.data(), bytes, threads);
      EXPECT_TRUE(std::equal(from.begin(), from.end() - 1, to.begin()));
      EXPECT_EQ(to.back(), 'y');
      zeroShared(to.data(), bytes, threads);
      EXPECT_EQ(std::count(to.begin(), to.end(), '\0'), static_cast<std::ptrdiff_t>(bytes));
      EXPECT_EQ(to.back(), 'y');
    }
}

} // namespace
} // namespace grouser::base
