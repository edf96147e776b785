// SPDX-License-Identifier: BSD-3-Clause
// Output of a run that ended with a simulation error: enough to find the cause.
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

/// Grains in three loose layers, so soft that the highest ones overlap the floor by more than max_overlap.
constexpr const char* kBed = R"(version = 1
[run]
duration = 0.05
time_step = 1e-4
output_interval = 5e-3
frame_interval = 1e-2
max_overlap = 0.05
[material.soil]
stiffness = 8e3
restitution = 0.9
[terrain]
heightmap = "heightmaps/flat.png"
size = [0.32, 0.32]
height_range = [0, 0.1]
material = "soil"
grain_radius = 0.02
layers = 3
arrangement = "lattice"
floor_grains = false
wall_friction = 0.5
)";

/// A ball that falls 0.1 m and also overlaps too far, after 0.14 s.
constexpr const char* kBall = R"(version = 1
[run]
duration = 1
time_step = 1e-4
output_interval = 5e-3
frame_interval = 2e-2
max_overlap = 0.05
[material.soil]
stiffness = 1e4
[[plane]]
material = "soil"
[[grain]]
position = [0, 0, 0.12]
radius = 0.02
material = "soil"
)";

class FailedRun : public ProgramTest {
protected:
  std::string manifest() const { return contents(folder_ / "o/manifest.json"); }
  bool has(const char* name) const { return fs::exists(folder_ / "o" / name) && fs::file_size(folder_ / "o" / name); }
  /// The manifest contains the reason, in the words of the message, and lists the output files.
  void expectExplained(const Outcome& o, std::initializer_list<const char*> files) {
    EXPECT_EQ(o.code, 3) << o.errors;
    ASSERT_NE(o.error(), "") << o.errors;
    EXPECT_NE(manifest().find("\"status\": \"failed\""), std::string::npos) << manifest();
    EXPECT_NE(manifest().find(o.error()), std::string::npos) << manifest();
    for (const char* file : files) {
      EXPECT_TRUE(has(file)) << file;
      EXPECT_NE(manifest().find('"' + std::string(file) + '"'), std::string::npos) << file;
    }
  }
};

TEST_F(FailedRun, FaultWhileTheBedSettlesIsSaidToBeOneAndShown) {
  put(folder_ / "bed.toml", kBed);
  const Outcome o = call("run bed.toml --out o --threads 1");
  EXPECT_NE(o.errors.find("while the bed settled, before the start of the run: step "), std::string::npos) << o.errors;
  expectExplained(o, {"frames.h5", "frames.xdmf", "picture.png", "scene.toml"});
  EXPECT_NE(manifest().find("\"phase\": \"settling\""), std::string::npos) << manifest();
  EXPECT_NE(manifest().find("\"cause\": \"unsettled bed\""), std::string::npos) << manifest();
}

TEST_F(FailedRun, BedThatDoesNotComeToRestIsShown) {
  put(folder_ / "bed.toml", kBed);
  const Outcome o =
      call("run bed.toml --out o --threads 1 --set run.max_overlap=1 --set terrain.settle_time_limit=0.1");
  EXPECT_NE(o.errors.find("did not settle within 0.1 s"), std::string::npos) << o.errors;
  expectExplained(o, {"frames.h5", "frames.xdmf", "picture.png"});
}

TEST_F(FailedRun, FaultOfARunLeavesLastFrameAndTheStateBeforeIt) {
  put(folder_ / "ball.toml", kBall);
  const Outcome o = call("run ball.toml --out o --threads 1");
  EXPECT_EQ(o.errors.find("settled"), std::string::npos) << o.errors;
  expectExplained(o, {"frames.h5", "frames.xdmf", "picture.png", "checkpoint.h5", "results.h5"});
  EXPECT_NE(manifest().find("\"cause\": \"pressed grain\""), std::string::npos) << manifest();
  EXPECT_NE(o.errors.find("(last checkpoint: o/checkpoint.h5, step "), std::string::npos) << o.errors;
  // Eight frames up to 0.14 s, and the one in which the overlap is too deep.
  EXPECT_NE(contents(folder_ / "o/frames.xdmf").find("/000008/grains/position"), std::string::npos);
  // The state before the fault is valid: a resumed run fails alike, and continues if max_overlap is larger.
  const auto messageOf = [](const Outcome& outcome) {
    const std::size_t at = outcome.errors.find("step ");
    return outcome.errors.substr(at, outcome.errors.find("(last") - at);
  };
  const Outcome again = call("run ball.toml --out o --resume --threads 1");
  EXPECT_EQ(again.code, 3);
  EXPECT_EQ(messageOf(again), messageOf(o));
  const std::string softer = " --set run.max_overlap=0.5 --hash --threads 1";
  const Outcome on = call("run ball.toml --out o --resume" + softer),
                whole = call("run ball.toml --out whole" + softer);
  EXPECT_EQ(on.code, 0) << on.errors;
  EXPECT_EQ(on.hash(), whole.hash());
}

TEST_F(FailedRun, RowsSoFarAreDrawn) {
  if (shell("/usr/bin/python3 -c 'import h5py, matplotlib'").code != 0) GTEST_SKIP() << "no Python packages for plots";
  put(folder_ / "ball.toml", kBall);
  expectExplained(call("run ball.toml --out o --threads 1"), {"ledger.png"});
}

} // namespace
} // namespace grouser::commands
