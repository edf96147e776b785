// SPDX-License-Identifier: BSD-3-Clause
// Default number of threads: the lowest of affinity, CPU quota and OpenMP's variables, with its cause.
#include "base/cpu_threads.hpp"

#include "base/error.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace grouser::base {
namespace {

/// Folder with files of cgroups.
class CpuThreadsTest : public test::FolderTest {
protected:
  void TearDown() override {
    unsetenv("OMP_NUM_THREADS");
    test::FolderTest::TearDown();
  }
  void write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file) << text;
  }
};

TEST_F(CpuThreadsTest, QuotaIsTheLowestOfTheCgroupAndItsParents) {
  EXPECT_FALSE(cpuQuota("0::/a/b\n", folder_));
  write("a/b/cpu.max", "max 100000\n");
  EXPECT_FALSE(cpuQuota("0::/a/b\n", folder_)) << "no quota";
  write("a/cpu.max", "150000 100000\n");
  EXPECT_EQ(cpuQuota("0::/a/b\n", folder_), 1.5) << "parent";
  write("a/b/cpu.max", "50000 100000\n");
  EXPECT_EQ(cpuQuota("0::/a/b\n", folder_), 0.5);
  EXPECT_EQ(cpuQuota("0::/a\n", folder_), 1.5);
  EXPECT_FALSE(cpuQuota("0::/\n", folder_)) << "another cgroup";
}

TEST_F(CpuThreadsTest, QuotaOfAContainer) {
  write("cpu.max", "300000 200000\n");
  EXPECT_EQ(cpuQuota("0::/\n", folder_), 1.5);
  EXPECT_EQ(cpuQuota("0::/system.slice/docker-1.scope\n", folder_), 1.5) << "the path is that of the host";
}

TEST_F(CpuThreadsTest, QuotaOfCgroupsOfVersionOne) {
  const std::string own = "12:memory:/m\n4:cpu,cpuacct:/job/7\n3:cpuset:/\n";
  EXPECT_FALSE(cpuQuota(own, folder_));
  write("cpu,cpuacct/job/7/cpu.cfs_quota_us", "-1\n");
  write("cpu,cpuacct/job/7/cpu.cfs_period_us", "100000\n");
  write("memory/m/cpu.cfs_quota_us", "1000\n");
  EXPECT_FALSE(cpuQuota(own, folder_)) << "no quota; not a cgroup of the controller cpu";
  write("cpu,cpuacct/job/cpu.cfs_quota_us", "250000\n");
  write("cpu,cpuacct/job/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(cpuQuota(own, folder_), 2.5);
  write("cpu/job/7/cpu.cfs_quota_us", "25000\n");
  write("cpu/job/7/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(cpuQuota(own, folder_), 0.25) << "mounted under the name of the controller";
}

TEST_F(CpuThreadsTest, LowestLimitNamesItsCause) {
  ThreadLimits limits;
  limits.machine = limits.affinity = 8;
  const auto check = [&](int count, int cores, const std::string& cause, int ranks = 1) {
    const CpuThreads t = lowestLimit(limits, ranks);
    EXPECT_EQ(t.count, count) << cause;
    EXPECT_EQ(t.cores, cores) << cause;
    EXPECT_EQ(t.machine, 8);
    EXPECT_EQ(t.cause, cause);
  };
  check(8, 8, "");
  limits.ompNumThreads = 16;
  check(8, 8, "");
  limits.affinity = 6;
  check(6, 6, "the CPU affinity of the process");
  limits.quota = 6.0;
  check(6, 6, "the CPU affinity of the process");
  limits.quota = 4.5;
  check(5, 5, "a CPU quota of 4.5 cores");
  check(2, 2, "a CPU quota of 4.5 cores", 3);
  limits.ompNumThreads = 3;
  check(3, 5, "OMP_NUM_THREADS = 3");
  limits.ompThreadLimit = 2;
  check(2, 5, "OMP_THREAD_LIMIT = 2");
  limits.quota = 0.05;
  check(1, 1, "a CPU quota of 0.05 cores");
  limits.quota = 1.0;
  check(1, 1, "a CPU quota of 1 core");
}

TEST_F(CpuThreadsTest, OmpNumThreadsIsAListOfPositiveNumbers) {
  unsetenv("OMP_NUM_THREADS");
  EXPECT_FALSE(ompNumThreads());
  for (const auto& [text, count] : {std::pair{"3", 3}, {"4,2", 4}, {" 5 ", 5}, {"6 , 1", 6}}) {
    setenv("OMP_NUM_THREADS", text, 1);
    EXPECT_EQ(ompNumThreads(), count) << text;
  }
  for (const char* text : {"", " "}) {
    setenv("OMP_NUM_THREADS", text, 1);
    EXPECT_FALSE(ompNumThreads()) << "'" << text << "'";
  }
  for (const char* text : {"0", "-1", "abc", "2.5", "2x", "4,", ",4", "4,0", "99999999999", "0x2", "+2"}) {
    setenv("OMP_NUM_THREADS", text, 1);
    try {
      cpuThreads();
      ADD_FAILURE() << text;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("OMP_NUM_THREADS = '" + std::string(text) + "' must be"), std::string::npos)
          << e.what();
    }
    EXPECT_FALSE(threadLimits().ompNumThreads) << text;
  }
}

TEST_F(CpuThreadsTest, InvalidOmpNumThreadsIsHiddenFromOpenMpButStillAnError) {
  setenv("OMP_NUM_THREADS", "abc", 1);
  hideInvalidOmpNumThreads();
  EXPECT_EQ(getenv("OMP_NUM_THREADS"), nullptr) << "the OpenMP library would complain about it";
  try {
    ompNumThreads();
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()).find("OMP_NUM_THREADS = 'abc' must be"), 0u) << e.what();
  }
  setenv("OMP_NUM_THREADS", "3", 1);
  hideInvalidOmpNumThreads();
  EXPECT_EQ(ompNumThreads(), 3) << "a valid number remains, and has priority";
  unsetenv("GROUSER_INVALID_OMP_NUM_THREADS");
}

TEST_F(CpuThreadsTest, RanksShareOnlyTheCoresThatSeveralMayUse) {
  using Mask = std::vector<std::uint64_t>;
  const Mask four{0b1111}, low{0b0011}, high{0b1100}, beyond{0, 0b111};
  EXPECT_EQ(shareOfCores(four, {four}), 4);
  EXPECT_EQ(shareOfCores(four, {four, four}), 2);
  EXPECT_EQ(shareOfCores(four, {four, four, four}), 1);
  EXPECT_EQ(shareOfCores(four, std::vector<Mask>(9, four)), 1) << "more ranks than cores";
  EXPECT_EQ(shareOfCores(low, {low, high}), 2) << "bound to cores of their own";
  EXPECT_EQ(shareOfCores(high, {low, high}), 2);
  EXPECT_EQ(shareOfCores(four, {four, low}), 3) << "two cores alone, two shared";
  EXPECT_EQ(shareOfCores(beyond, {four, beyond}), 3);
  EXPECT_EQ(coresIn(beyond), 3);
  EXPECT_GE(coresIn(affinityMask()), 1);
}

} // namespace
} // namespace grouser::base
