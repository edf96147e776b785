// SPDX-License-Identifier: BSD-3-Clause
#include "runs/jobs/shared_work.hpp"

#include "base/error.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/not_written.hpp"
#include "tests/message_of.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace grouser::jobs {
namespace {

namespace fs = std::filesystem;

class SharedWork : public test::FolderTest {};

TEST_F(SharedWork, EveryPieceIsDoneOnceWhoeverDoesIt) {
  for (const int processes : {1, 3, 8}) {
    const fs::path folder = folder_ / std::to_string(processes);
    fs::create_directories(folder);
    int done = 0;
    shareWork(
        processes, 5,
        [&](std::size_t i) { std::ofstream(folder / std::to_string(i), std::ios::app) << getpid() << '\n'; },
        [&] { ++done; });
    EXPECT_EQ(done, 5);
    std::vector<std::string> pids;
    for (int i = 0; i < 5; ++i) {
      std::ifstream file(folder / std::to_string(i));
      std::string first, second;
      EXPECT_TRUE(std::getline(file, first));
      EXPECT_FALSE(std::getline(file, second));
      pids.push_back(first);
    }
    std::sort(pids.begin(), pids.end());
    EXPECT_LE(std::unique(pids.begin(), pids.end()) - pids.begin(), std::min(processes, 5));
    EXPECT_EQ(std::count(pids.begin(), pids.end(), std::to_string(getpid())), processes == 1 ? 5 : 0);
  }
}

TEST_F(SharedWork, WhoHasALongPieceLeavesTheOthersToTheRest) {
  const auto isThere = [&](std::size_t i) { return fs::exists(folder_ / std::to_string(i)); };
  const auto waits = [&](std::size_t i) {
    for (int k = 0; i == 0 && !(isThere(1) && isThere(2) && isThere(3)); ++k) {
      if (k == 2000) throw std::runtime_error("nobody does the others");
      usleep(10'000);
    }
    std::ofstream(folder_ / std::to_string(i)) << i;
  };
  shareWork(2, 4, waits, [] {});
  EXPECT_TRUE(isThere(0));
}

TEST_F(SharedWork, FailureOfOneKeepsItsKind) {
  const auto fails = [](const auto& error) {
    shareWork(
        2, 2,
        [&](std::size_t i) {
          if (i) throw error;
        },
        [] {});
  };
  EXPECT_THROW(fails(base::SimulationError("a")), base::SimulationError);
  EXPECT_THROW(fails(base::DeviceError("a")), base::DeviceError);
  EXPECT_THROW(fails(support::NotWritten("a")), support::NotWritten);
}

TEST_F(SharedWork, FailureOfOneEndsAllWithItsMessage) {
  const auto failing = [](std::size_t i) {
    if (i == 1) throw base::InputError("piece 1 is bad");
    if (i != 0) usleep(20'000'000); // far beyond the test's duration: the process must be ended
  };
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < 20; ++k) EXPECT_EQ(test::messageOf([&] { shareWork(3, 3, failing, [] {}); }), "piece 1 is bad");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(15)); // no process was waited for
  EXPECT_THROW(shareWork(
                   2, 2,
                   [](std::size_t i) {
                     if (i) std::raise(SIGKILL);
                   },
                   [] {}),
               base::DeviceError);
  EXPECT_THROW(shareWork(
                   2, 2,
                   [](std::size_t i) {
                     if (i) _exit(0);
                   },
                   [] {}),
               std::runtime_error);
}

TEST_F(SharedWork, ProcessesTakeTheGpusInTurn) {
  setenv(support::kFirstGpu, "1", 1);
  const auto found = [&] {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.insert(entry.path().filename());
    return names;
  };
  // Each piece waits for the others, so that each process computes one.
  const auto work = [&](std::size_t) {
    std::ofstream(folder_ / std::getenv(support::kFirstGpu)) << "\n";
    for (int look = 0; look < 1000 && found().size() < 3; ++look)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  };
  shareWork(3, 3, work, [] {});
  EXPECT_EQ(found(), (std::set<std::string>{"1", "2", "3"}));
  unsetenv(support::kFirstGpu);
}

} // namespace
} // namespace grouser::jobs
