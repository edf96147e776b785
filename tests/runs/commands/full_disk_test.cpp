// SPDX-License-Identifier: BSD-3-Clause
// A full disk, or a limit on file sizes, at any time of a run: one message, a manifest with the cause, and
// a checkpoint to resume from.
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <set>
#include <unistd.h>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

/// 300 rows of 64 grains on a floor, a frame every tenth row and a checkpoint every twentieth.
constexpr const char* kScene = R"(version = 1
[run]
duration = 0.03
time_step = 1e-4
output_interval = 1e-4
frame_interval = 1e-3
checkpoint_interval = 2e-3
[material.soil]
stiffness = 1e5
[terrain]
heightmap = "heightmaps/flat.png"
size = [0.32, 0.32]
height_range = [0, 0.1]
material = "soil"
grain_radius = 0.02
layers = 1
arrangement = "lattice"
floor_grains = false
wall_friction = 0.5
settle_time_limit = 0.0
[output]
plots = false
)";

class FullDisk : public ProgramTest {
protected:
  void SetUp() override {
    ProgramTest::SetUp();
    put(folder_ / "bed.toml", kScene);
  }
  Outcome run(const std::string& words, const std::string& before = "") const {
    return call("run bed.toml --threads 1 " + words, before);
  }

  /// The run that met the limit: prints one message and keeps all earlier good files. Returns the file that
  /// could not be written.
  std::string expectFailedSoundly(const Outcome& o, const std::string& out, const std::string& more,
                                  const std::string& hash) {
    EXPECT_EQ(o.code, 3) << o.errors;
    const std::string message = o.error();
    EXPECT_NE(message, "") << "one message: " << o.errors;
    if (message.empty()) return "";
    EXPECT_NE(message.find("is the disk full"), std::string::npos) << o.errors;
    if (fs::exists(folder_ / out)) {
      const std::string manifest = contents(folder_ / out / "manifest.json");
      EXPECT_NE(manifest.find("\"status\": \"failed\""), std::string::npos) << message << "\n" << manifest;
      EXPECT_NE(manifest.find(message), std::string::npos) << manifest;
    }
    if (fs::exists(folder_ / out / "checkpoint.h5")) {
      const Outcome on = run("--resume --hash --out " + out + more);
      EXPECT_EQ(on.code, 0) << message << "\n" << on.errors;
      EXPECT_EQ(on.hash(), hash);
      ++resumed_;
    }
    return fs::path(message.substr(0, message.find(": "))).filename().string();
  }

  int resumed_ = 0;
};

TEST_F(FullDisk, LimitToTheSizeOfAnyFileLosesNothing) {
  std::set<std::string> met;
  // The fastest-growing file reaches the limit first; without it, another file. Many grains have a large checkpoint.
  const std::string csv = " --set output.grains_csv=false",
                    frames = csv + " --set output.frames=false --set output.picture_width=2400",
                    picture = frames + " --set output.picture=false", many = picture + " --set 'terrain.size=[3, 3]'";
  for (const std::string& more : {std::string(), csv, frames, picture, many}) {
    const Outcome free = run("--hash --out free --force" + more);
    ASSERT_EQ(free.code, 0) << free.errors;
    for (const int kib : {1,   10,  45,  60,  75,  90,  105, 120, 140, 160,  180, 200,
                          220, 240, 270, 300, 350, 400, 500, 600, 800, 1000, 1500}) {
      const std::string out = "full" + std::to_string(kib);
      fs::remove_all(folder_ / out);
      const Outcome o = run("--out " + out + more, "ulimit -c 0; ulimit -f " + std::to_string(2 * kib) + "; ");
      if (o.code == 0) break;
      met.insert(expectFailedSoundly(o, out, more, free.hash()));
    }
  }
  for (const char* file : {"scene.toml", "results.h5", "frames.h5", "grains.csv", "picture.png", "checkpoint.h5.part"})
    EXPECT_TRUE(met.contains(file)) << file;
  EXPECT_GT(resumed_, 5);
}

TEST_F(FullDisk, LeavesTheLastMomentsWhereNoCheckpointWasAskedFor) {
  const std::string more = " --set run.checkpoint_interval=0 --set output.picture=false";
  const Outcome free = run("--hash --out free" + more);
  ASSERT_EQ(free.code, 0) << free.errors;
  for (const int kib : {1000, 1100, 1250}) {
    const std::string out = "full" + std::to_string(kib);
    const Outcome o = run("--out " + out + more, "ulimit -c 0; ulimit -f " + std::to_string(2 * kib) + "; ");
    ASSERT_EQ(o.code, 3) << kib << o.errors;
    EXPECT_NE(o.errors.find("(last checkpoint: " + out + "/checkpoint.h5, step "), std::string::npos) << o.errors;
    expectFailedSoundly(o, out, more, free.hash());
  }
  EXPECT_EQ(resumed_, 3);
}

TEST_F(FullDisk, AFolderThatIsGoneOrClosedIsSaidToBe) {
  const std::string make = "mkdir -p out && chmod u+w out; ", wait =
                                                                  "while [ ! -s out/timeseries.csv ]; do sleep 0.01; "
                                                                  "done; ";
  const std::string begin =
      make + "\"$grouser\" run bed.toml --out out --force --threads 1 --set run.duration=1 & pid=$!; " + wait;
  const Outcome gone = shell(begin + "mv out moved; wait $pid");
  EXPECT_EQ(gone.code, 3) << gone.errors;
  EXPECT_NE(gone.error().find("its folder is gone"), std::string::npos) << gone.errors;
  if (geteuid() == 0) return; // root may write anywhere
  const Outcome closed = shell(begin + "chmod u-w out; wait $pid");
  EXPECT_EQ(closed.code, 3) << closed.errors;
  EXPECT_NE(closed.error().find("no write permission"), std::string::npos) << closed.errors;
}

TEST_F(FullDisk, SmallDiskLosesNothing) {
  const std::string disk = folder_.string() + "/disk";
  fs::create_directory(disk);
  // A separate mount namespace: the mount ends with the process.
  if (shell("unshare -m -r mount -t tmpfs -o size=1m none " + disk).code != 0)
    GTEST_SKIP() << "mounting a small disk is not permitted on this machine";
  const std::string more = " --set output.picture=false --set output.grains_csv=false";
  const Outcome free = run("--hash --out free" + more);
  ASSERT_EQ(free.code, 0) << free.errors;
  std::set<std::string> met;
  for (const int kib : {16, 64, 500, 1100, 1265, 1270, 1275, 1280, 1285, 1290, 1300, 1400, 1500}) {
    const std::string out = "full" + std::to_string(kib);
    const Outcome o = shell("export grouser disk=" + disk + " out=" + out + " size=" + std::to_string(kib) +
                            "; unshare -m -r sh -c 'mount -t tmpfs -o size=${size}k none $disk; ulimit -c 0; "
                            "\"$grouser\" run bed.toml --threads 1 --out disk/run" +
                            more + "; code=$?; test -d disk/run && cp -r disk/run $out; exit $code'");
    if (o.code == 0) continue;
    if (o.code == 2) { // a run that cannot fit does not start
      EXPECT_NE(o.error().find("exceeds the resources of this machine: its results require"), std::string::npos)
          << o.errors;
      EXPECT_FALSE(fs::exists(folder_ / out));
      continue;
    }
    met.insert(expectFailedSoundly(o, out, more, free.hash()));
  }
  EXPECT_TRUE(met.contains("frames.h5"));
  EXPECT_GT(resumed_, 0);
}

} // namespace
} // namespace grouser::commands
