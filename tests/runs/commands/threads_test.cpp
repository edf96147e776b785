// SPDX-License-Identifier: BSD-3-Clause
// Number of CPU threads of a run: what limits it is in the line "device", and has no effect on the results.
#include "tests/runs/ranks_fixture.hpp"

#include <gtest/gtest.h>

#include <regex>
#include <thread>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

/// Runs the bed of OnRanks.
class Threads : public OnRanks {
protected:
  Outcome bed(const std::string& before, const std::string& words = "", int ranks = 1) const {
    return ProgramTest::shell("export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
                              "OMPI_MCA_rmaps_base_oversubscribe=1 "
                              "PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe; unset OMP_NUM_THREADS; " +
                              before + (ranks > 1 ? " mpirun -np " + std::to_string(ranks) : std::string()) +
                              " \"$grouser\" run bed.toml --device cpu --steps 60 --hash --force --out o " + words);
  }
  static std::string device(const Outcome& o) {
    std::smatch match;
    return std::regex_search(o.out, match, std::regex("device +(.*)")) ? match[1].str() : o.out + o.errors;
  }
};

TEST_F(Threads, LimitsOfTheEnvironmentAreFollowedAndPrinted) {
  const std::string hash = bed("", "--threads 1").hash();
  EXPECT_TRUE(hash.starts_with("state-hash")) << hash;
  const Outcome free = bed("");
  const std::string all = device(free).substr(0, device(free).find(" on "));
  struct Case {
    const char *before, *words;
    std::string starts, cause;
  };
  for (const Case& c :
       {Case{"OMP_NUM_THREADS=1", "", "1 thread on ", "OMP_NUM_THREADS = 1"},
        Case{"OMP_NUM_THREADS=1,3", "", "1 thread on ", "OMP_NUM_THREADS = 1"},
        Case{"OMP_THREAD_LIMIT=1", "", "1 thread on ", "OMP_THREAD_LIMIT = 1"},
        Case{"taskset -c 0", "", "1 thread on ", "the CPU affinity of the process"},
        // An explicit number has priority, except over OMP_THREAD_LIMIT.
        Case{"OMP_NUM_THREADS=1", "--threads 2", "2 threads on ", "OMP_NUM_THREADS = 1"},
        Case{"OMP_NUM_THREADS=abc", "--threads 2", "2 threads on ", ""},
        Case{"OMP_THREAD_LIMIT=1", "--threads 2", "1 thread on ", "OMP_THREAD_LIMIT = 1"},
        // The program restarts itself; it must not inherit the core to which OpenMP binds its first thread.
        Case{"OMP_PROC_BIND=true", "", all, ""}, Case{"OMP_DYNAMIC=true", "--threads 3", "3 threads on ", ""}}) {
    const Outcome o = bed(c.before, c.words);
    EXPECT_EQ(o.hash(), hash) << c.before << ' ' << c.words << o.errors;
    EXPECT_EQ(device(o).rfind(c.starts, 0), 0u) << c.before << ' ' << c.words << ": " << device(o);
    if (c.cause.empty()) continue;
    EXPECT_NE(device(o).find("; default: 1 of "), std::string::npos) << device(o);
    EXPECT_NE(device(o).find("(" + c.cause + ")"), std::string::npos) << device(o);
    EXPECT_NE(contents(folder_ / "o/manifest.json").find(c.cause), std::string::npos) << "manifest";
  }
}

TEST_F(Threads, InvalidNumberIsAnInputErrorThatNamesTheVariable) {
  for (const char* value : {"0", "-1", "abc", "4,,2"}) {
    const Outcome o = bed("OMP_NUM_THREADS=" + std::string(value));
    EXPECT_EQ(o.code, 2) << value;
    EXPECT_EQ(o.error().rfind("OMP_NUM_THREADS = '" + std::string(value) + "' must be a number of threads", 0), 0u)
        << o.errors;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "o"));
  }
}

TEST_F(Threads, SpheresReportAnInvalidNumberToo) {
  const Outcome o = ProgramTest::shell("OMP_NUM_THREADS=abc \"$grouser\" spheres " GROUSER_SOURCE_DIR
                                       "/assets/meshes/shoe.obj --count 20");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.errors.find("grouser: error: OMP_NUM_THREADS = 'abc' must be a number of threads"), std::string::npos)
      << o.errors;
  const std::size_t first = o.errors.find("libgomp");
  EXPECT_EQ(first == std::string::npos ? first : o.errors.find("libgomp", first + 8), std::string::npos)
      << "once at most: " << o.errors;
}

TEST_F(Threads, BoundRanksKeepTheirCores) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one core";
  const std::string hash = bed("", "--threads 1").hash();
  // Both ranks may use both cores; each is bound to one; one rank is bound to two cores.
  for (const std::string binding : {"--bind-to none", "--bind-to core"}) {
    const Outcome o =
        ProgramTest::shell("export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; unset OMP_NUM_THREADS; "
                           "taskset -c 0,1 mpirun "
                           "--oversubscribe -np 2 " +
                           binding + " \"$grouser\" run bed.toml --device cpu --steps 60 --hash --force --out o");
    EXPECT_EQ(o.hash(), hash) << binding << o.errors;
    EXPECT_EQ(device(o).rfind("1 thread on ", 0), 0u) << binding << ": " << device(o);
  }
  const Outcome two = ProgramTest::shell(
      "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; export OMP_NUM_THREADS=2; mpirun "
      "--oversubscribe -np 2 --bind-to none \"$grouser\" run bed.toml --device cpu --threads 2 --steps 60 --hash "
      "--force "
      "--out o");
  EXPECT_EQ(two.hash(), hash) << two.errors;
  EXPECT_EQ(device(two).rfind("2 threads on ", 0), 0u) << device(two);
}

} // namespace
} // namespace grouser::commands
