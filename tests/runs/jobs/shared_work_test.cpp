// SPDX-License-Identifier: BSD-3-Clause
// Work that several processes of one call share.
#include "runs/jobs/shared_work.hpp"

#include "runs/support/device_choice.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>

namespace grouser::jobs {
namespace {

namespace fs = std::filesystem;

class SharedWork : public test::FolderTest {
protected:
  void TearDown() override {
    unsetenv(support::kFirstGpu);
    test::FolderTest::TearDown();
  }
};

TEST_F(SharedWork, EachProcessTakesAnotherGpu) {
  setenv(support::kFirstGpu, "1", 1);
  const auto found = [&] {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.insert(entry.path().filename());
    return names;
  };
  // Each piece waits for the others, so that each process does one.
  const auto work = [&](std::size_t) {
    std::ofstream(folder_ / std::getenv(support::kFirstGpu)) << "\n";
    for (int look = 0; look < 1000 && found().size() < 3; ++look)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  };
  shareWork(3, 3, work, [] {});
  EXPECT_EQ(found(), (std::set<std::string>{"1", "2", "3"}));
}

} // namespace
} // namespace grouser::jobs
