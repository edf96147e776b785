// SPDX-License-Identifier: BSD-3-Clause
// A device failure during a run: here a CPU that briefly runs out of memory, caused by fail_allocation.cpp.
// The message contains the time and the command to resume.
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

/// Grains that slide down with frequent rebuilds. No checkpoint is requested.
constexpr const char* kScene = R"(version = 1
[run]
duration = 0.1
time_step = 1e-4
output_interval = 1e-3
checkpoint_interval = 0
gravity = [5, 0, -8]
[material.soil]
stiffness = 1e5
[terrain]
heightmap = "heightmaps/flat.png"
size = [0.64, 0.32]
height_range = [0, 0.1]
material = "soil"
grain_radius = 0.02
layers = 2
arrangement = "lattice"
floor_grains = false
wall_friction = 0.5
settle_time_limit = 0.0
[output]
plots = false
picture = false
)";

class DeviceFailure : public ProgramTest {
protected:
  void SetUp() override {
    ProgramTest::SetUp();
    library_ = programUnderTest().parent_path() / "fail_allocation.so";
    if (!fs::exists(library_)) GTEST_SKIP() << "not built: sanitizers have their own allocator";
    put(folder_ / "bed.toml", kScene);
  }
  /// `fails`: number of the failing allocation; 0: none.
  Outcome run(const std::string& words, long fails) const {
    return call("run bed.toml --device cpu --threads 1 --hash " + words,
                fmt::format("FAIL_ALLOCATION={} LD_PRELOAD='{}' ", fails, library_.string()));
  }

  fs::path library_;
};

TEST_F(DeviceFailure, LeavesTheLastGoodStateToGoOnFrom) {
  const Outcome free = run("--out free", 0);
  ASSERT_EQ(free.code, 0) << free.errors;
  std::smatch all;
  ASSERT_TRUE(std::regex_search(free.errors, all, std::regex("allocations ([0-9]+)"))) << free.errors;
  // Near the end of a run with many rebuilds.
  const Outcome o = run("--out out", std::stol(all[1]) * 4 / 5);
  ASSERT_EQ(o.code, 4) << o.errors;
  std::smatch said;
  const std::string message = o.error();
  ASSERT_TRUE(std::regex_match(
      message, said,
      std::regex("step ([0-9]+), time 0\\.0[0-9]* s: out of host memory.* \\(last checkpoint: out/checkpoint\\.h5, "
                 "step ([0-9]+)\\)")))
      << o.errors;
  EXPECT_GT(std::stol(said[2]), 100) << "not the initial state";
  EXPECT_LE(std::stol(said[2]), std::stol(said[1]));
  const std::string manifest = contents(folder_ / "out" / "manifest.json");
  EXPECT_NE(manifest.find("\"status\": \"failed\""), std::string::npos) << manifest;
  EXPECT_NE(manifest.find("out of host memory"), std::string::npos) << manifest;
  const Outcome on = run("--resume --out out", 0);
  EXPECT_EQ(on.code, 0) << on.errors;
  EXPECT_EQ(on.hash(), free.hash());
}

} // namespace
} // namespace grouser::commands
