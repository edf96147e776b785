// SPDX-License-Identifier: BSD-3-Clause
// Loops on a CPU: shared by their cost, each item once, whatever the threads.
#include "base/array.hpp"
#include "base/for_each.cuh"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace grouser::base {
namespace {

/// Who does the items. Where `patient`, an item waits until another thread does one too: nothing else shows on a busy
/// machine that a loop was offered to others.
struct NoteThread {
  double cost; // [ns] that the loop is told
  bool patient;
  std::thread::id caller;
  std::thread::id* by;
  std::atomic<int>* others;
  std::chrono::steady_clock::time_point end;

  double nanoseconds() const { return cost; }
  void operator()(int i) const {
    by[i] = std::this_thread::get_id();
    if (by[i] != caller) ++*others;
    while (patient && *others == 0 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  }
};

int itemsOfOthers(int items, double cost, int threads, bool patient) {
  std::vector<std::thread::id> by(static_cast<std::size_t>(items));
  std::atomic<int> others{0};
  forEach(cpuExec(threads), "note threads", items,
          NoteThread{cost, patient, std::this_thread::get_id(), by.data(), &others,
                     std::chrono::steady_clock::now() + std::chrono::seconds(10)});
  return others;
}

TEST(ThreadTeam, FortyBlocksOfGrainsAreSharedAndAHundredCheapItemsAreNot) {
  EXPECT_GT(itemsOfOthers(40, 60.0 * 256, 2, true), 0);
  EXPECT_GT(itemsOfOthers(2, 60.0 * 256, 2, true), 0);
  int shared = 0;
  for (int k = 0; k < 100; ++k) shared += itemsOfOthers(100, 5, 8, false);
  EXPECT_EQ(shared, 0);
  EXPECT_EQ(itemsOfOthers(40, 60.0 * 256, 1, false), 0);
}

TEST(ThreadTeam, ThreadsFollowFromTheCostOfAllItems) {
  EXPECT_EQ(sharesOfLoop(100, 5, 8).threads, 1);
  EXPECT_EQ(sharesOfLoop(40, 60.0 * 256, 2).threads, 2);
  EXPECT_EQ(sharesOfLoop(40, 60.0 * 256, 16).threads, 16);
  EXPECT_EQ(sharesOfLoop(40, 60.0 * 256, 16).chunk, 1);
  EXPECT_EQ(sharesOfLoop(3, 1e6, 16).threads, 3) << "no more threads than items";
  EXPECT_EQ(sharesOfLoop(1, 1e9, 16).threads, 1);
  EXPECT_EQ(sharesOfLoop(0, 5, 16).threads, 1);
  const LoopShares some = sharesOfLoop(5000, 5, 16);
  EXPECT_EQ(some.threads, 6) << "each for the cost of 4 us";
  const LoopShares many = sharesOfLoop(2000000000, 5, 16);
  EXPECT_EQ(many.threads, 16);
  EXPECT_GT(many.chunk, 100) << "taking a chunk costs as much as several items";
  EXPECT_LT(many.chunk, 2000000000 / 16 / 8);
}

struct CountItem {
  static constexpr double kNanoseconds = 1000;
  std::uint32_t* times;
  void operator()(int i) const { atomicAdd32(times + i, 1); }
};

TEST(ThreadTeam, EachItemIsDoneOnceByAnyNumberOfThreads) {
  for (const int threads : {1, 2, 3, 8, 40})
    for (const int items : {1, 2, 63, 64, 1000, 4099}) {
      std::vector<std::uint32_t> times(static_cast<std::size_t>(items));
      for (int k = 0; k < 50; ++k) forEach(cpuExec(threads), "count", items, CountItem{times.data()});
      EXPECT_EQ(times, std::vector<std::uint32_t>(times.size(), 50)) << items << " items, " << threads << " threads";
    }
}

struct LoopInLoop {
  static constexpr double kNanoseconds = 1e5;
  std::uint32_t* times;
  void operator()(int i) const { forEach(cpuExec(4), "inner", 100, CountItem{times + 100 * i}); }
};

TEST(ThreadTeam, LoopsWithinLoopsAndBesideLoopsAreDone) {
  std::vector<std::uint32_t> times(1600);
  forEach(cpuExec(4), "outer", 16, LoopInLoop{times.data()});
  EXPECT_EQ(times, std::vector<std::uint32_t>(1600, 1));
  std::vector<std::uint32_t> beside(1600);
  const auto loop = [](std::vector<std::uint32_t>& counts) {
    for (int k = 0; k < 200; ++k) forEach(cpuExec(3), "beside", 1600, CountItem{counts.data()});
  };
  std::thread other(loop, std::ref(beside));
  loop(times);
  other.join();
  EXPECT_EQ(times, std::vector<std::uint32_t>(1600, 201));
  EXPECT_EQ(beside, std::vector<std::uint32_t>(1600, 200));
}

TEST(ThreadTeam, MemoryIsZeroedAndCopiedToItsLastByte) {
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

TEST(ThreadTeam, AForkedChildWorksAlone) {
  std::vector<std::uint32_t> times(1000);
  forEach(cpuExec(4), "count", 1000, CountItem{times.data()});
  const pid_t child = fork();
  if (child == 0) {
    alarm(20);
    forEach(cpuExec(4), "count", 1000, CountItem{times.data()});
    const Array<char> large(cpuExec(4), std::size_t{4} << 20);
    _exit(times == std::vector<std::uint32_t>(1000, 2) ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

} // namespace
} // namespace grouser::base
