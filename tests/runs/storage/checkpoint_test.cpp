// SPDX-License-Identifier: BSD-3-Clause
// Checkpoints: a resumed run equals an uninterrupted one, bit for bit; a file is complete or rejected.
#include "runs/setup/load_scene.hpp"
#include "runs/storage/checkpoint.hpp"
#include "runs/storage/scene_changes.hpp"

#include "base/error.hpp"
#include "base/hash.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/support/hdf5_file.hpp"
#include "runs/support/sealed_file.hpp"
#include "tests/device_under_test.hpp"
#include "tests/runs/folder_fixture.hpp"
#include "tests/runs/shared_cache.hpp"
#include "tests/runs/soil_fixture.hpp"
#include "vehicle/observation_table.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstring>
#include <fstream>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace grouser::storage {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

void quiet(double, double) {}

/// Contents of a row: equal numbers mean equal bits, and NaN equals NaN.
std::vector<std::uint64_t> rowOf(coupling::Simulation& simulation) {
  const coupling::Ledger l = simulation.ledger();
  std::vector<double> row{l.driveWork, l.kinetic, l.potential, l.elastic, l.dissipated.total(), l.residual};
  for (int a = 0; a < 3; ++a) row.push_back(l.impulseResidual[a]);
  row.push_back(static_cast<double>(l.grainContacts + 1000 * l.partContacts + 1000000 * l.patches));
  if (simulation.vehicle())
    for (const double v : vehicle::flatten(simulation.vehicle()->observe())) row.push_back(v);
  std::vector<std::uint64_t> bits(row.size());
  std::memcpy(bits.data(), row.data(), row.size() * sizeof(double));
  return bits;
}

class CheckpointFile : public FolderTest {
protected:
  void SetUp() override {
    FolderTest::SetUp();
    path_ = folder_ / "checkpoint.h5";
  }

  static scene::Scene grains(const std::vector<std::string>& overrides = {}) {
    return setup::parseScene(
        "version = 1\n[run]\nduration = 0.1\ntime_step = 1e-5\n[material.glass]\n[[plane]]\n"
        "material = \"glass\"\n[[grain]]\nposition = [0, 0, 0.0098]\nradius = 0.01\nmaterial = "
        "\"glass\"\n[[grain]]\nposition = [0.0195, 0.001, 0.0101]\nvelocity = [-1, 0, 0]\nradius = "
        "0.01\nmaterial = \"glass\"\n",
        "grains.toml", overrides);
  }

  /// A checkpoint of two touching grains, after `steps`.
  static Checkpoint small(std::int64_t steps = 5) {
    coupling::Simulation simulation(setup::simulationSetup(grains()), base::cpuExec(1), quiet);
    while (simulation.steps() < steps) simulation.step();
    Checkpoint c;
    c.scene = scene::resolvedToml(grains()), c.inputs = setup::inputsOf(grains()), c.commit = "here";
    c.timeStep = simulation.timeStep(), c.rows = 3, c.frames = 2;
    c.state = simulation.save();
    return c;
  }

  std::string refusal(const std::string& bytes) const {
    put(path_, bytes);
    try {
      readCheckpoint(path_);
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "";
  }

  fs::path path_;
};

/// Runs a scene with short ramps to `stop`, resumes it from a file with `overrides` on `exec`, and compares
/// the two at `end`.
void expectOneAnswer(const fs::path& path, const std::string& scene, std::vector<std::string> overrides,
                     const base::Exec& exec, std::int64_t stop, std::int64_t end) {
  const std::string file = testScene(scene);
  const std::vector<std::string> ramps = {"driver.tension_ramp=0.01", "driver.weight_ramp=0.01",
                                          "driver.drive_ramp=0.02", "driver.drive_start=0.02"};
  overrides.insert(overrides.end(), ramps.begin(), ramps.end());
  coupling::Simulation straight(setup::simulationSetup(setup::loadScene(file, ramps)), base::cpuExec(1), quiet, {},
                                sharedBeds(), sharedSpheres());
  while (straight.steps() < stop - 37) straight.step();
  straight.restartMeans(); // a row was written: means restart here
  while (straight.steps() < stop) straight.step();
  const coupling::Ledger touching = straight.ledger();
  ASSERT_GT(touching.partContacts + touching.patches, 20) << "history is required for the test";
  const scene::Scene again = setup::loadScene(file, overrides);
  Checkpoint c;
  c.scene = scene::resolvedToml(setup::loadScene(file, ramps)), c.inputs = setup::inputsOf(again),
  c.state = straight.save();
  writeCheckpoint(path, c);
  const Checkpoint read = readCheckpoint(path);
  EXPECT_NO_THROW(checkSameScene(read, path, setup::provenanceOf(again)));
  EXPECT_EQ(read.state.hash(), straight.stateHash());
  coupling::Simulation resumed(setup::simulationSetup(again), exec, read.state, {}, sharedSpheres());
  EXPECT_EQ(resumed.steps(), stop);
  EXPECT_EQ(resumed.stateHash(), straight.stateHash());
  EXPECT_EQ(rowOf(resumed), rowOf(straight)) << "before the first step";
  EXPECT_EQ(resumed.save().vehicle->alarmSteps, straight.save().vehicle->alarmSteps);
  EXPECT_EQ(resumed.save().vehicle->alarmForces, straight.save().vehicle->alarmForces);
  for (coupling::Simulation* s : {&straight, &resumed})
    while (s->steps() < end) s->step();
  EXPECT_EQ(resumed.stateHash(), straight.stateHash());
  EXPECT_EQ(rowOf(resumed), rowOf(straight));
  const coupling::VehicleState a = *resumed.save().vehicle, b = *straight.save().vehicle;
  EXPECT_EQ(a.groundForces, b.groundForces);
  EXPECT_EQ(a.contacts.impulseOnParts, b.contacts.impulseOnParts);
}

TEST_F(CheckpointFile, VehicleOnItsBedGoesOnToTheSameBits) {
  expectOneAnswer(path_, "coupled.toml", {"run.skin=0.5", "run.duration=9"}, base::cpuExec(2), 410, 490);
}

TEST_F(CheckpointFile, VehicleOnRigidGroundGoesOnToTheSameBits) {
  expectOneAnswer(path_, "rigid.toml", {"output.frames=false"}, base::cpuExec(2), 610, 690);
}

TEST_F(CheckpointFile, VehicleGoesFromTheCpuToCuda) {
  if (!base::cudaAvailable()) GTEST_SKIP() << "no CUDA device";
  expectOneAnswer(path_, "coupled.toml", {}, base::cudaExec(), 410, 490);
}

TEST_F(CheckpointFile, ReadsBackToTheSameBits) {
  const Checkpoint c = small();
  ASSERT_FALSE(c.state.grains->neighbour.empty()) << "the two must touch";
  writeCheckpoint(path_, c);
  const Checkpoint read = readCheckpoint(path_);
  EXPECT_EQ(read.scene, c.scene);
  EXPECT_EQ(read.commit, "here");
  EXPECT_EQ(read.rows, 3);
  EXPECT_EQ(read.frames, 2);
  EXPECT_EQ(read.state.steps, 5);
  EXPECT_EQ(read.state.hash(), c.state.hash());
  EXPECT_EQ(read.state.grains->words(), c.state.grains->words());
  EXPECT_EQ(read.state.grains->travelled, c.state.grains->travelled);
  EXPECT_EQ(read.state.ledgerAtStart, c.state.ledgerAtStart);
}

TEST_F(CheckpointFile, AnyByteThatDiffersIsSeen) {
  writeCheckpoint(path_, small());
  const std::string whole = contents(path_);
  ASSERT_EQ(refusal(whole), "");
  for (std::size_t i = 0; i < whole.size(); i += i < support::kSealBytes ? 1 : 61) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ (1 << i % 8));
    EXPECT_NE(refusal(bytes), "") << "byte " << i;
  }
}

TEST_F(CheckpointFile, CutForeignAndOtherVersionsAreRefusedByName) {
  writeCheckpoint(path_, small());
  const std::string whole = contents(path_);
  for (const std::size_t length :
       {whole.size() - 1, whole.size() / 2, support::kSealBytes, support::kSealBytes - 1, std::size_t{10}})
    EXPECT_NE(refusal(whole.substr(0, length)).find("damaged"), std::string::npos) << length;
  EXPECT_NE(refusal(whole + '\0').find("damaged"), std::string::npos);
  EXPECT_NE(refusal("").find("not a checkpoint"), std::string::npos);
  EXPECT_NE(refusal("version = 1\n").find("not a checkpoint"), std::string::npos);
  { support::Hdf5File::create(path_).write("/steps", std::vector<std::int64_t>{1}, {1}); }
  EXPECT_NE(refusal(contents(path_)).find("not a checkpoint"), std::string::npos) << "results.h5 is HDF5 too";
  std::string other = whole;
  const std::size_t version = other.find("\nversion ") + 9;
  other[version] = static_cast<char>(other[version] + 1);
  const std::string number = other.substr(version, other.find('\n', version) - version);
  EXPECT_NE(refusal(other).find("version " + number + ", but this program reads version"), std::string::npos)
      << refusal(other);
  fs::remove(path_);
  EXPECT_THROW(readCheckpoint(path_), base::InputError);
  EXPECT_THROW(readCheckpoint(folder_), base::InputError);
}

TEST_F(CheckpointFile, AnotherSceneIsRefusedByItsKey) {
  const Checkpoint c = small();
  for (const char* key : {"run.gravity=[0,0,-9]", "run.time_step=2e-5", "run.seed=8", "material.glass.friction=0.4"}) {
    try {
      checkSameScene(c, path_, setup::provenanceOf(grains({key})));
      ADD_FAILURE() << key;
    } catch (const base::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(std::string(key).substr(4, 4)), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("--resume"), std::string::npos) << error.what();
    }
  }
  for (const char* key : {"run.duration=7", "run.output_interval=0.5", "run.frame_interval=0.5", "run.threads=3",
                          "run.checkpoint_interval=0", "run.device=cpu", "run.skin=0.7", "run.max_overlap=0.3",
                          "output.frames=false", "output.folder=elsewhere"})
    EXPECT_NO_THROW(checkSameScene(c, path_, setup::provenanceOf(grains({key})))) << key;
}

TEST_F(CheckpointFile, FilesOfTheSceneAreComparedByWhatIsInThem) {
  const fs::path assets = fs::path(GROUSER_SOURCE_DIR) / "assets";
  const auto terrain = [&](const std::string& map) {
    return setup::parseScene("version = 1\n[run]\nduration = 1\n[material.soil]\n[terrain]\nheightmap = \"" + map +
                                 "\"\nsize = [1, 1]\nheight_range = [0, 0.1]\nmaterial = \"soil\"\nkind = \"rigid\"\n",
                             folder_ / "scene.toml");
  };
  fs::copy(assets / "heightmaps/hills.png", folder_ / "map.png");
  fs::copy(assets / "heightmaps/hills.png", folder_ / "copy.png");
  Checkpoint c;
  c.scene = scene::resolvedToml(terrain("map.png")), c.inputs = setup::inputsOf(terrain("map.png"));
  EXPECT_NO_THROW(checkSameScene(c, path_, setup::provenanceOf(terrain("copy.png"))));
  fs::copy(assets / "heightmaps/flat.png", folder_ / "map.png", fs::copy_options::overwrite_existing);
  try {
    checkSameScene(c, path_, setup::provenanceOf(terrain("map.png")));
    ADD_FAILURE();
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("terrain.heightmap"), std::string::npos) << error.what();
  }
}

TEST_F(CheckpointFile, EveryByteOfAFileOfTheSceneCounts) {
  // Files are read in blocks of 1 MiB; the hash covers their bytes in order.
  for (const std::size_t size :
       {std::size_t{1}, (std::size_t{1} << 20) - 1, std::size_t{1} << 20, std::size_t{2500000}}) {
    std::string bytes(size, 'a');
    bytes.back() = '\xff';
    std::ofstream(folder_ / "map.png", std::ios::binary) << bytes;
    base::StateHash hash;
    for (const char c : bytes) hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
    scene::Scene scene = grains();
    scene.terrain.emplace().heightmap = (folder_ / "map.png").string();
    EXPECT_EQ(setup::inputsOf(scene), "terrain.heightmap " + hash.hex() + "\n") << size;
  }
}

TEST_F(CheckpointFile, FullDiskLeavesTheFormerOneAsItWas) {
  writeCheckpoint(path_, small(5));
  const std::string former = contents(path_);
  const auto oldHandler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{}, narrow{};
  getrlimit(RLIMIT_FSIZE, &limit);
  const Checkpoint next = small(40);
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{300}, former.size() / 2, former.size() - 1}) {
    narrow = limit, narrow.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &narrow);
    EXPECT_THROW(writeCheckpoint(path_, next), std::runtime_error) << bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
    EXPECT_EQ(contents(path_), former) << bytes;
    EXPECT_FALSE(fs::exists(path_.string() + ".part")) << bytes;
  }
  std::signal(SIGXFSZ, oldHandler);
  writeCheckpoint(path_, next);
  EXPECT_EQ(readCheckpoint(path_).state.steps, 40);
}

TEST_F(CheckpointFile, KilledAtAnyTimeItIsWhole) {
  const Checkpoint a = small(5), b = small(40);
  writeCheckpoint(path_, a);
  int cutShort = 0;
  for (int i = 0; i < 40; ++i) {
    const pid_t child = fork();
    if (child == 0)
      for (;;) writeCheckpoint(path_, b), writeCheckpoint(path_, a);
    usleep(static_cast<useconds_t>(1000 + 733 * i));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    cutShort += fs::exists(path_.string() + ".part");
    const std::int64_t steps = readCheckpoint(path_).state.steps;
    EXPECT_TRUE(steps == 5 || steps == 40) << steps;
  }
  EXPECT_GT(cutShort, 0) << "no kill interrupted a write";
}

class SoilOfACheckpoint : public SoilTest {};

TEST_F(SoilOfACheckpoint, MustBeThatOfTheSceneByItsBytes) {
  const auto parse = [&](const std::string& file) {
    return setup::parseScene(grainOf("a", 0.01, "[material.a]\nsoil = \"" + file + "\"\n"), folder_ / "scene.toml");
  };
  put(folder_ / "mine.toml", kLoam);
  Checkpoint c;
  c.scene = scene::resolvedToml(parse("mine.toml")), c.inputs = setup::inputsOf(parse("mine.toml"));
  put(folder_ / "copy.toml", kLoam);
  EXPECT_NO_THROW(checkSameScene(c, "c.h5", setup::provenanceOf(parse("copy.toml")))) << "by its bytes";
  put(folder_ / "mine.toml", std::string(kLoam) + "# a remark\n");
  EXPECT_THROW(checkSameScene(c, "c.h5", setup::provenanceOf(parse("mine.toml"))), base::InputError);
}

} // namespace
} // namespace grouser::storage
