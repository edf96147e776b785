// SPDX-License-Identifier: BSD-3-Clause
// `grouser run --resume`: the folder of a resumed run equals the folder of an uninterrupted run.
#include "runs/commands/run_scene.hpp"
#include "runs/setup/load_scene.hpp"

#include "base/error.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/storage/checkpoint.hpp"
#include "runs/support/hdf5_file.hpp"
#include "runs/support/stop_signals.hpp"
#include "tests/message_of.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <map>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

/// Every file of a folder with its contents.
std::map<std::string, std::string> snapshot(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    files[entry.path().filename().string()] = contents(entry.path());
  return files;
}

std::vector<std::uint64_t> bits(const std::vector<double>& numbers) {
  std::vector<std::uint64_t> words(numbers.size());
  std::memcpy(words.data(), numbers.data(), numbers.size() * sizeof(double));
  return words;
}

/// A loose bed of 450 grains that collapses on its floor: settling stops early.
constexpr const char* kBed = R"(version = 1
[run]
duration = 0.2
time_step = 1e-4
output_interval = 0.01
frame_interval = 0.03
checkpoint_interval = 0.04
threads = 1
[material.soil]
stiffness = 1e5
[terrain]
heightmap = "heightmaps/hills.png"
size = [1.0, 1.0]
height_range = [0, 0.05]
material = "soil"
grain_radius = 0.03
layers = 2
arrangement = "lattice"
floor_grains = false
wall_friction = 0.5
settle_kinetic_energy = 1
settle_time_limit = 1
[output]
plots = false
picture = false
)";

class ResumedRun : public FolderTest {
protected:
  void SetUp() override {
    FolderTest::SetUp();
    resumed_ = folder_ / "resumed";
  }

  static scene::Scene bed(const std::vector<std::string>& overrides = {}) {
    return setup::parseScene(kBed, "bed.toml", overrides);
  }

  output::Summary run(const fs::path& folder, const scene::Scene& scene, std::optional<std::int64_t> steps = {},
                      bool force = false) {
    session::RunRequest options;
    options.folder = folder, options.hash = true, options.steps = steps, options.force = force;
    return runScene(scene, setup::provenanceOf(scene), options);
  }
  output::Summary resume(const scene::Scene& scene, std::optional<std::int64_t> steps = {}, bool force = false) {
    session::RunRequest options;
    options.folder = resumed_, options.hash = true, options.steps = steps, options.force = force;
    options.resume = resumed_ / storage::kCheckpointName;
    return runScene(scene, setup::provenanceOf(scene), options);
  }
  /// Hash of the uninterrupted run, in folder "straight".
  std::string straight() { return run(folder_ / "straight", bed()).stateHash; }

  /// All results of the two runs are equal: rows, frames, state.
  void expectSameFolders() {
    const fs::path whole = folder_ / "straight";
    EXPECT_EQ(contents(resumed_ / "timeseries.csv"), contents(whole / "timeseries.csv"));
    EXPECT_EQ(contents(resumed_ / "frames.xdmf"), contents(whole / "frames.xdmf"));
    const support::Hdf5File a = support::Hdf5File::open(resumed_ / "results.h5"),
                            b = support::Hdf5File::open(whole / "results.h5");
    EXPECT_EQ(a.numbers("/series/step").size(), 21u);
    for (const char* name : {"/series/step", "/series/time", "/terrain/rebuilds/value", "/terrain/contacts/value",
                             "/ledger/residual/value", "/ledger/impulse_residual/value", "/terrain/max_overlap/step"})
      EXPECT_EQ(bits(a.numbers(name)), bits(b.numbers(name))) << name;
    const support::Hdf5File p = support::Hdf5File::open(resumed_ / "frames.h5"),
                            q = support::Hdf5File::open(whole / "frames.h5");
    for (int i = 0; i < 8; ++i)
      for (const char* name : {"position", "speed"}) {
        const std::string dataset = "/00000" + std::to_string(i) + "/grains/" + name;
        EXPECT_EQ(p.numbers(dataset), q.numbers(dataset)) << dataset;
      }
    EXPECT_FALSE(p.has("/000008"));
    const storage::Checkpoint c = storage::readCheckpoint(resumed_ / storage::kCheckpointName),
                              d = storage::readCheckpoint(whole / storage::kCheckpointName);
    EXPECT_EQ(c.state.hash(), d.state.hash());
    EXPECT_EQ(c.rows, d.rows);
    EXPECT_EQ(c.frames, d.frames);
    EXPECT_EQ(c.state.grains->rebuilds, d.state.grains->rebuilds);
    EXPECT_EQ(c.state.grains->ledgerSums, d.state.grains->ledgerSums);
  }

  fs::path resumed_; ///< the folder of the resumed run
};

TEST_F(ResumedRun, BedStoppedBetweenRowsEndsAsIfItHadNotBeenStopped) {
  const std::string hash = straight();
  run(resumed_, bed(), 1234);
  EXPECT_EQ(resume(bed({"run.threads=2"})).stateHash, hash);
  expectSameFolders();
}

TEST_F(ResumedRun, RowsAndFramesAfterTheCheckpointAreCut) {
  const std::string hash = straight();
  run(resumed_, bed(), 850);
  fs::copy(resumed_ / storage::kCheckpointName, folder_ / "earlier.h5");
  resume(bed(), 1710);
  // As after a kill at step 1710 or later with the last checkpoint at step 850.
  fs::rename(folder_ / "earlier.h5", resumed_ / storage::kCheckpointName);
  EXPECT_EQ(resume(bed()).stateHash, hash);
  expectSameFolders();
}

TEST_F(ResumedRun, LastRowAndFrameOfAShorterRunAreCut) {
  const std::string hash = straight();
  run(resumed_, bed(), 1234);
  ASSERT_EQ(support::Hdf5File::open(resumed_ / "results.h5").numbers("/series/step").back(), 1234)
      << "a row for its own end";
  EXPECT_EQ(resume(bed()).stateHash, hash);
  expectSameFolders();
  EXPECT_EQ(resume(bed()).stateHash, hash) << "nothing to do";
  expectSameFolders();
}

TEST_F(ResumedRun, ADamagedManifestIsRefusedUnlessForced) {
  const std::string hash = straight();
  run(resumed_, bed(), 1234);
  const fs::path file = resumed_ / "manifest.json";
  const std::string whole = contents(file), rows = contents(resumed_ / "timeseries.csv");
  std::string altered = whole;
  altered[altered.find("\"steps\": 1234") + 9] = '2';
  std::string unnamed = whole;
  unnamed[unnamed.rfind("\"checksum\"") + 1] = 'b';
  for (const std::string& text :
       {altered, unnamed, whole.substr(0, whole.size() / 2), std::string("[1]"), std::string("{")}) {
    std::ofstream(file) << text;
    const std::string said = test::messageOf([this] { resume(bed()); });
    EXPECT_NE(said.find("manifest.json: wrong checksum: the file is damaged; restore it"), std::string::npos) << said;
    EXPECT_EQ(contents(file), text);
    EXPECT_EQ(contents(resumed_ / "timeseries.csv"), rows);
  }
  EXPECT_EQ(resume(bed(), {}, true).stateHash, hash);
  expectSameFolders();
}

TEST_F(ResumedRun, KilledRunGoesOnFromItsLastCheckpoint) {
  const std::string hash = straight();
  const pid_t child = fork();
  if (child == 0) {
    // A step of this bed takes well under a millisecond: the kill time is arbitrary.
    std::thread([this] {
      while (!fs::exists(resumed_ / storage::kCheckpointName)) usleep(200);
      usleep(30'000);
      kill(getpid(), SIGKILL);
    }).detach();
    run(resumed_, bed());
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status)) << "the run ended before it was killed";
  EXPECT_EQ(resume(bed()).stateHash, hash);
  expectSameFolders();
}

TEST_F(ResumedRun, SignalStopsWithACheckpointAndGoesOn) {
  const std::string hash = straight();
  std::thread interrupter([this] {
    while (!fs::exists(resumed_ / "timeseries.csv")) usleep(200);
    usleep(50'000);
    kill(getpid(), SIGINT);
  });
  try {
    run(resumed_, bed({"run.checkpoint_interval=0"}));
    ADD_FAILURE() << "the run completed";
  } catch (const support::Stopped& stopped) {
    EXPECT_EQ(stopped.signal(), SIGINT);
    EXPECT_NE(std::string(stopped.what()).find("checkpoint.h5"), std::string::npos) << stopped.what();
  }
  interrupter.join();
  EXPECT_NE(contents(resumed_ / "manifest.json").find("\"status\": \"stopped\""), std::string::npos);
  EXPECT_EQ(resume(bed()).stateHash, hash);
  EXPECT_NE(contents(resumed_ / "manifest.json").find("\"status\": \"finished\""), std::string::npos);
  expectSameFolders();
}

TEST_F(ResumedRun, NothingLeftToDoKeepsTheForcesOfTheLastFrame) {
  const auto scene = [] { return bed({"run.duration=0.1"}); }; // step 1000, between the frames at 900 and 1200
  run(resumed_, scene());
  const auto forces = [&] {
    return support::Hdf5File::open(resumed_ / "frames.h5").numbers("/000004/grains/contact_force");
  };
  const std::vector<double> before = forces();
  ASSERT_FALSE(std::isnan(before.at(0)));
  const std::string rows = contents(resumed_ / "timeseries.csv");
  resume(scene());
  EXPECT_EQ(bits(forces()), bits(before));
  EXPECT_EQ(contents(resumed_ / "timeseries.csv"), rows);
  // A longer run has no frame at this step.
  resume(bed());
  EXPECT_EQ(support::Hdf5File::open(resumed_ / "frames.h5").number("/000004", "step"), 1200);
}

TEST_F(ResumedRun, LongerDurationGoesOnFromTheEnd) {
  const std::string hash = straight();
  run(resumed_, bed({"run.duration=0.1"}));
  EXPECT_EQ(resume(bed()).stateHash, hash);
  expectSameFolders();
}

TEST_F(ResumedRun, SingleGrainsGoOnToTheSameHash) {
  const auto scene = [] {
    return setup::parseScene(
        "version = 1\n[run]\nduration = 0.05\ntime_step = 1e-5\noutput_interval = 0.01\n"
        "[material.glass]\nfriction = 0.3\n[[plane]]\nmaterial = \"glass\"\n[[plane]]\npoint = [0.05, 0, "
        "0]\nnormal = [-1, 0, 1]\nmaterial = \"glass\"\n[[grain]]\nposition = [0, 0, 0.02]\nvelocity = "
        "[1, 0, 0]\nspin = [0, 9, 0]\nradius = 0.01\nmaterial = \"glass\"\n[[grain]]\nposition = [0.021, "
        "0.001, 0.0101]\nradius = 0.01\nmaterial = \"glass\"\n[output]\npicture = false\n",
        "grains.toml");
  };
  const std::string hash = run(folder_ / "straight", scene()).stateHash;
  run(resumed_, scene(), 1);
  for (const std::int64_t step : {900, 1700, 3000}) resume(scene(), step);
  EXPECT_EQ(resume(scene()).stateHash, hash);
  EXPECT_EQ(contents(resumed_ / "timeseries.csv"), contents(folder_ / "straight/timeseries.csv"));
}

TEST_F(ResumedRun, WhatIsRefusedTouchesNothing) {
  run(resumed_, bed(), 900);
  const auto before = snapshot(resumed_);
  EXPECT_THROW(resume(bed({"run.seed=2"})), base::InputError) << "another scene";
  EXPECT_THROW(resume(bed(), 899), base::InputError) << "beyond the end";
  const std::string whole = before.at(storage::kCheckpointName);
  const auto put = [&](const char* name, const std::string& bytes) {
    std::ofstream(resumed_ / name, std::ios::binary) << bytes;
    return snapshot(resumed_);
  };
  const auto damaged = put(storage::kCheckpointName, whole.substr(0, whole.size() - 100));
  EXPECT_THROW(resume(bed()), base::InputError);
  EXPECT_EQ(snapshot(resumed_), damaged);
  put(storage::kCheckpointName, whole);
  const auto noRows = put("results.h5", before.at("results.h5").substr(0, 3000));
  EXPECT_THROW(resume(bed()), base::InputError);
  EXPECT_EQ(snapshot(resumed_), noRows);
  put("results.h5", before.at("results.h5"));
  const auto noFrames = put("frames.h5", "no frames");
  EXPECT_THROW(resume(bed()), base::InputError);
  EXPECT_EQ(snapshot(resumed_), noFrames);
  put("frames.h5", before.at("frames.h5"));
  EXPECT_EQ(snapshot(resumed_), before);
  EXPECT_EQ(resume(bed()).stateHash, straight());
}

TEST_F(ResumedRun, WithoutItsRowsItGoesOnByForce) {
  run(resumed_, bed(), 900);
  fs::remove(resumed_ / "results.h5");
  EXPECT_THROW(resume(bed()), base::InputError);
  EXPECT_EQ(resume(bed(), {}, true).stateHash, straight());
  EXPECT_EQ(support::Hdf5File::open(resumed_ / "results.h5").numbers("/series/step").front(), 1000);
}

/// A grain that falls for 45 ms and then exceeds max_overlap on the plane.
scene::Scene unsound(const std::string& checkpointInterval) {
  return setup::parseScene(
      "version = 1\n[run]\nduration = 0.1\ntime_step = 1e-5\nmax_overlap = 1e-4\ncheckpoint_interval = " +
          checkpointInterval +
          "\n[material.glass]\n[[plane]]\nmaterial = \"glass\"\n[[grain]]\nposition = [0, 0, 0.02]\n"
          "radius = 0.01\nmaterial = \"glass\"\n",
      "fall.toml");
}

TEST_F(ResumedRun, UnsoundRunKeepsItsLastSoundCheckpoint) {
  try {
    run(resumed_, unsound("0.01"));
    ADD_FAILURE() << "the grain has not reached the plane";
  } catch (const base::SimulationError& error) {
    EXPECT_NE(std::string(error.what()).find("checkpoint.h5, step 4000"), std::string::npos) << error.what();
  }
  EXPECT_EQ(storage::readCheckpoint(resumed_ / storage::kCheckpointName).state.steps, 4000);
}

TEST_F(ResumedRun, NewRunByForceTakesTheFormerCheckpointAway) {
  run(resumed_, bed(), 900);
  EXPECT_THROW(run(resumed_, unsound("0"), {}, true), base::SimulationError);
  const auto left = storage::readCheckpoint(resumed_ / storage::kCheckpointName).state.grains;
  ASSERT_TRUE(left);
  EXPECT_EQ(left->total, 1) << "it would belong to the bed of the previous run";
}

} // namespace
} // namespace grouser::commands
