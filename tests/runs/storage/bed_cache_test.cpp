// SPDX-License-Identifier: BSD-3-Clause
// Settled beds in the cache: bitwise identical to newly settled beds, and never a cause of failed runs.
#include "runs/setup/load_scene.hpp"
#include "runs/storage/bed_cache.hpp"

#include "base/error.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/support/file_lock.hpp"
#include "runs/support/folder_use.hpp"
#include "runs/support/kept_files.hpp"
#include "tests/device_under_test.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <pwd.h>
#include <thread>
#include <unistd.h>

namespace grouser::storage {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

class KeptBed : public FolderTest {
protected:
  void SetUp() override {
    FolderTest::SetUp();
    fs::remove(folder_); // the first bed creates it
  }

  /// 180 settling grains, and one that falls onto them.
  static scene::Scene scene(const std::vector<std::string>& overrides = {}, const std::string& more = "") {
    return setup::parseScene(
        "version = 1\n[run]\nduration = 0.1\ntime_step = 2e-4\n[material.soil]\nstiffness = 1e5\n"
        "restitution = 0.2\n[material.steel]\nstiffness = 1e7\n[terrain]\nheightmap = "
        "\"heightmaps/hills.png\"\nsize = [0.6, 0.6]\nheight_range = [0, 0.03]\nmaterial = \"soil\"\n"
        "grain_radius = 0.03\nlayers = 2\narrangement = \"lattice\"\nfloor_grains = false\nwall_friction = "
        "0.5\nsettle_kinetic_energy = 1e-2\n[[source]]\nlow = [0.3, 0, "
        "0.4]\nhigh = [0.3, 0, 0.4]\nradius = 0.03\nmaterial = \"soil\"\ntotal = 1\nevery = 1\n" +
            more,
        "bed.toml", overrides);
  }

  /// Number of settling steps: zero for a cached bed.
  struct Outcome {
    std::string hash, summary;
    bool settled = false;
    std::vector<double> row;
  };
  Outcome run(BedCache* beds, const std::vector<std::string>& overrides = {},
              const base::Exec& exec = base::cpuExec(1)) const {
    Outcome o;
    coupling::Simulation simulation(
        setup::simulationSetup(scene(overrides)), exec, [&](double, double) { o.settled = true; }, {}, beds);
    const auto note = [&] {
      const coupling::Ledger l = simulation.ledger();
      for (const double v :
           {l.kinetic, l.potential, l.elastic, l.dissipated.total(), l.residual, static_cast<double>(l.grainContacts),
            simulation.settled().time, simulation.settled().energyRatio, simulation.time()})
        o.row.push_back(v);
    };
    note();
    while (simulation.steps() < 300) simulation.step();
    note();
    o.hash = simulation.stateHash();
    if (beds) o.summary = beds->summary();
    return o;
  }
  Outcome runIn(const fs::path& folder, const std::vector<std::string>& overrides = {}) const {
    BedCache beds(folder);
    return run(&beds, overrides);
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder_))
      if (entry.path().extension() == ".h5") found.push_back(entry.path());
    return found;
  }
};

TEST_F(KeptBed, GivesTheBitsOfABedSettledAnew) {
  const Outcome alone = run(nullptr), first = runIn(folder_), second = runIn(folder_);
  EXPECT_TRUE(first.settled);
  EXPECT_FALSE(second.settled);
  for (const Outcome& o : {first, second}) {
    EXPECT_EQ(o.hash, alone.hash);
    EXPECT_EQ(o.row, alone.row);
  }
  EXPECT_NE(first.summary.find("cached in " + folder_.string()), std::string::npos) << first.summary;
  EXPECT_NE(second.summary.find("read from " + folder_.string()), std::string::npos) << second.summary;
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(KeptBed, OfCopiedTilesIsTakenBeforeItsTileSettles) {
  const std::vector<std::string> tiled{"terrain.size=[0.8,0.4]", "terrain.tile=[0.4,0.4]", "terrain.floor=flat"};
  const Outcome alone = run(nullptr, tiled), first = runIn(folder_, tiled);
  EXPECT_TRUE(first.settled);
  EXPECT_EQ(first.hash, alone.hash);
  // A tile that cannot come to rest shows whether it is settled.
  coupling::SimulationSetup setup = setup::simulationSetup(scene(tiled));
  auto restless = std::make_shared<coupling::GroundSetup>(*setup.ground.grains->bed->tile->ground);
  restless->grains->bed->settle.timeLimit = 1e-9;
  setup.ground.grains->bed->tile->ground = restless;
  const auto quiet = [](double, double) {};
  EXPECT_THROW(coupling::Simulation(setup, base::cpuExec(1), quiet), base::SimulationError);
  BedCache beds(folder_);
  coupling::Simulation kept(setup, base::cpuExec(1), quiet, {}, &beds);
  while (kept.steps() < 300) kept.step();
  EXPECT_EQ(kept.stateHash(), alone.hash);
  // A resumed run does not need it, either.
  coupling::Simulation resumed(setup, base::cpuExec(1), kept.save());
  while (resumed.steps() < 320) kept.step(), resumed.step();
  EXPECT_EQ(resumed.stateHash(), kept.stateHash());
}

TEST_F(KeptBed, ServesEverySkinAndEveryNumberOfThreads) {
  const Outcome first = runIn(folder_);
  BedCache beds(folder_);
  const Outcome other = run(&beds, {"run.skin=0.6"}, base::cpuExec(2));
  EXPECT_FALSE(other.settled);
  EXPECT_EQ(other.hash, first.hash);
}

TEST_F(KeptBed, ServesCuda) {
  if (!base::cudaAvailable()) GTEST_SKIP() << "no CUDA device";
  const Outcome first = runIn(folder_);
  BedCache beds(folder_);
  const Outcome other = run(&beds, {}, base::cudaExec());
  EXPECT_FALSE(other.settled);
  EXPECT_EQ(other.hash, first.hash);
}

TEST_F(KeptBed, WhatMadeItMakesAnother) {
  const std::string origin = setup::bedOrigin(scene(), 2e-4);
  EXPECT_NE(setup::bedOrigin(scene(), 1e-4), origin);
  for (const char* key :
       {"run.seed=2", "run.gravity=[0,0,-9]", "run.max_overlap=0.3", "material.soil.stiffness=2e5",
        "material.soil.friction=0.1", "terrain.layers=3", "terrain.grain_radius=0.02", "terrain.size=[0.6,0.7]",
        "terrain.height_range=[0,0.02]", "terrain.settle_kinetic_energy=1e-3", "terrain.walls=false",
        "terrain.ground_material=steel", "terrain.heightmap=heightmaps/flat.png"})
    EXPECT_NE(setup::bedOrigin(scene({key}), 2e-4), origin) << key;
}

TEST_F(KeptBed, WhatHasNoPartInItChangesNothing) {
  const std::string origin = setup::bedOrigin(scene(), 2e-4);
  fs::create_directories(folder_);
  fs::copy(fs::path(GROUSER_SOURCE_DIR) / "assets/heightmaps/hills.png", folder_ / "copy.png");
  for (const std::string& key :
       {std::string("run.duration=7"), std::string("run.skin=0.5"), std::string("run.threads=2"),
        std::string("run.device=cpu"), std::string("run.output_interval=0.03"),
        std::string("material.steel.friction=0"), std::string("output.frames=false"),
        std::string("parallel.rebalance=false"), std::string("source.0.total=2"),
        std::string("run.steps_per_contact=30"), "terrain.heightmap=" + (folder_ / "copy.png").string()})
    EXPECT_EQ(setup::bedOrigin(scene({key}), 2e-4), origin) << key;
}

TEST_F(KeptBed, KnowsWhereASurfaceStandsAndNotHowItWillMove) {
  const std::string box = "[[box]]\nposition = [0.3, 0, 0.2]\nsize = [0.2, 0.2, 0.1]\nmaterial = \"steel\"\n";
  const std::string plane = "[[plane]]\npoint = [0, 0, -1]\nmaterial = \"steel\"\n";
  const auto origin = [](const std::string& more, const std::vector<std::string>& overrides = {}) {
    return setup::bedOrigin(scene(overrides, more), 2e-4);
  };
  for (const char* key : {"box.0.velocity=[0, 0, -1]", "box.0.name=lid", "box.0.spin=[0, 0, 1]"})
    EXPECT_EQ(origin(box, {key}), origin(box)) << key;
  EXPECT_EQ(origin(box + "free = \"z\"\nmass = 5\nload = -3\n"), origin(box));
  for (const char* key :
       {"box.0.position.2=0.21", "box.0.size.0=0.1", "box.0.material=soil", "material.steel.friction=0"})
    EXPECT_NE(origin(box, {key}), origin(box)) << key;
  EXPECT_NE(origin(plane, {"plane.0.velocity=[1, 0, 0]"}), origin(plane)) << "one is a surface, the other a wall";
  EXPECT_EQ(origin(plane, {"plane.0.velocity=[1, 0, 0]"}), origin(plane, {"plane.0.name=belt"}));
}

TEST_F(KeptBed, DamagedOrForeignIsToldAndSettledAnew) {
  const Outcome first = runIn(folder_);
  ASSERT_EQ(files().size(), 1u);
  const fs::path file = files().front();
  const std::string whole = contents(file);
  std::string flipped = whole;
  flipped[whole.size() / 2] = static_cast<char>(flipped[whole.size() / 2] ^ 4);
  for (const std::string& bad : {flipped, whole.substr(0, whole.size() - 1), std::string("no bed"), std::string()}) {
    std::ofstream(file, std::ios::binary) << bad;
    ::testing::internal::CaptureStderr();
    const Outcome again = runIn(folder_);
    const std::string printed = ::testing::internal::GetCapturedStderr();
    EXPECT_NE(printed.find(file.string()), std::string::npos) << printed;
    EXPECT_TRUE(again.settled);
    EXPECT_EQ(again.hash, first.hash);
    EXPECT_FALSE(runIn(folder_).settled) << "a new bed replaces the damaged one";
  }
}

TEST_F(KeptBed, OfAnotherNameIsNotTaken) {
  runIn(folder_);
  const fs::path one = files().front();
  fs::rename(one, folder_ / "kept");
  const Outcome other = runIn(folder_, {"run.seed=2"});
  const fs::path two = files().front();
  fs::rename(folder_ / "kept", two); // as if two origins had one hash
  ::testing::internal::CaptureStderr();
  const Outcome again = runIn(folder_, {"run.seed=2"});
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("do not match the file name"), std::string::npos);
  EXPECT_TRUE(again.settled);
  EXPECT_EQ(again.hash, other.hash);
}

TEST_F(KeptBed, UnusableFolderIsAWarning) {
  std::ofstream(folder_) << "a file where the folder should be";
  ::testing::internal::CaptureStderr();
  const Outcome o = runIn(folder_ / "below");
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("cannot cache settled beds"), std::string::npos);
  EXPECT_EQ(o.hash, run(nullptr).hash);
  EXPECT_NE(o.summary.find("not cached"), std::string::npos);
}

TEST_F(KeptBed, OldestGoWhenTheLimitIsReached) {
  runIn(folder_);
  const std::uint64_t one = fs::file_size(files().front());
  runIn(folder_, {"run.seed=2"});
  fs::last_write_time(files().front(), fs::file_time_type::clock::now() - std::chrono::hours(1));
  const fs::path oldest = files().front();
  std::ofstream(folder_ / "mine.h5") << "not a bed: stays";
  std::ofstream(folder_ / "bed-0.h5.host.1.part") << "left by a killed run";
  fs::last_write_time(folder_ / "bed-0.h5.host.1.part", fs::file_time_type::clock::now() - std::chrono::hours(25));
  BedCache beds(folder_, 2 * one + one / 2);
  run(&beds, {"run.seed=3"});
  EXPECT_FALSE(fs::exists(oldest));
  EXPECT_EQ(files().size(), 3u) << "two beds and a stranger";
  EXPECT_FALSE(fs::exists(folder_ / "bed-0.h5.host.1.part"));
  BedCache none(folder_, 1);
  EXPECT_NE(run(&none, {"run.seed=4"}).summary.find("GROUSER_CACHE_GIB"), std::string::npos);
}

TEST_F(KeptBed, PartialFilesOfEndedProcessesAreDeletedAndOthersCount) {
  const support::KeptFiles cache(folder_, 1000);
  const fs::path file = folder_ / "bed-1.h5", fresh = support::KeptFiles::freshName(file);
  fs::create_directories(file); // the rename fails
  std::ofstream(fresh) << "bed";
  EXPECT_FALSE(cache.put(fresh, file));
  EXPECT_FALSE(fs::exists(fresh));
  fs::remove(file);
  const std::string name = fresh.string();
  const fs::path left = name.substr(0, name.rfind('.')) + ".999999999"; // larger than any process number
  const fs::path kept = folder_ / "bed-2.h5";
  for (const fs::path& part : {left, fresh, kept}) std::ofstream(part) << std::string(900, 'x');
  for (const fs::path& part : {left, fresh})
    fs::last_write_time(part, fs::file_time_type::clock::now() - std::chrono::hours(1));
  std::ofstream(folder_ / "new") << "bed";
  EXPECT_TRUE(cache.put(folder_ / "new", file));
  EXPECT_FALSE(fs::exists(left));
  EXPECT_TRUE(fs::exists(fresh)) << "this process still writes it";
  EXPECT_FALSE(fs::exists(kept)) << "the partial file counts";
}

TEST_F(KeptBed, PartialFilesAndLocksInUseElsewhereRemain) {
  const support::KeptFiles cache(folder_, 1000);
  const fs::path file = folder_ / "bed-1.h5";
  fs::create_directories(folder_);
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  // A container of the same host name numbers its processes apart.
  const fs::path other = fmt::format("{}.{}-1.999999999", file.string(), host.data());
  const fs::path held = support::KeptFiles::lockOf(folder_ / "bed-2.h5"), left = support::KeptFiles::lockOf(file);
  for (const fs::path& one : {other, held, left}) std::ofstream(one) << "";
  support::FileLock lock;
  ASSERT_TRUE(lock.take(held));
  fs::last_write_time(other, fs::file_time_type::clock::now() - std::chrono::hours(1));
  for (const fs::path& one : {held, left})
    fs::last_write_time(one, fs::file_time_type::clock::now() - std::chrono::hours(25));
  std::ofstream(folder_ / "new") << "bed";
  EXPECT_TRUE(cache.put(folder_ / "new", file));
  EXPECT_TRUE(fs::exists(other)) << "its writer is not known here";
  EXPECT_TRUE(fs::exists(held)) << "its holder makes a bed, although it wrote the lock long ago";
  EXPECT_FALSE(fs::exists(left));
  fs::last_write_time(other, fs::file_time_type::clock::now() - std::chrono::hours(25));
  std::ofstream(folder_ / "new") << "bed";
  EXPECT_TRUE(cache.put(folder_ / "new", file));
  EXPECT_FALSE(fs::exists(other));
}

TEST_F(KeptBed, SecondRunWaitsForTheFirst) {
  Outcome a, b;
  std::thread first([&] { a = runIn(folder_); });
  std::thread second([&] { b = runIn(folder_); });
  first.join(), second.join();
  EXPECT_EQ(a.hash, b.hash);
  EXPECT_EQ((a.summary.rfind("settled", 0) == 0) + (b.summary.rfind("settled", 0) == 0), 1) << a.summary << "\n"
                                                                                            << b.summary;
}

TEST_F(KeptBed, FolderComesFromTheSurroundings) {
  struct Restore {
    const char* name;
    std::optional<std::string> value;
    explicit Restore(const char* n) : name(n) {
      if (const char* v = std::getenv(n)) value = v;
    }
    ~Restore() { value ? setenv(name, value->c_str(), 1) : unsetenv(name); }
  } const a("GROUSER_CACHE"), b("XDG_CACHE_HOME"), c("HOME"), d("GROUSER_CACHE_GIB");
  setenv("GROUSER_CACHE", "", 1);
  EXPECT_FALSE(BedCache::ofUser());
  unsetenv("GROUSER_CACHE"), unsetenv("XDG_CACHE_HOME"), unsetenv("HOME");
  EXPECT_EQ(support::KeptFiles::ofUser()->folder(), fs::path(getpwuid(getuid())->pw_dir) / ".cache/grouser");
  setenv("HOME", folder_.c_str(), 1);
  const auto home = BedCache::ofUser();
  ASSERT_TRUE(home);
  BedCache beds = *home;
  EXPECT_NE(run(&beds).summary.find((folder_ / ".cache/grouser/bed-").string()), std::string::npos) << beds.summary();
  for (const char* bad : {"two", "-1", "1e9", "1 ", "nan"}) {
    setenv("GROUSER_CACHE_GIB", bad, 1);
    EXPECT_THROW(BedCache::ofUser(), base::InputError) << bad;
  }
}

/// /proc/locks does not list this process among others, as it does not list processes of other containers.
TEST(FileLock, AFolderInUseIsRefusedWithoutTheTableOfLocks) {
  const fs::path folder = fs::path(::testing::TempDir()) / ("grouser_used_" + std::to_string(getpid()));
  fs::create_directories(folder);
  EXPECT_NO_THROW(support::requireUnused(folder));
  support::FileLock lock;
  ASSERT_TRUE(lock.take(folder));
  EXPECT_THROW(support::requireUnused(folder), base::InputError);
  lock.release();
  EXPECT_NO_THROW(support::requireUnused(folder));
  fs::remove(folder);
}

TEST(FileLock, ADeletedLockFileIsMadeAgain) {
  const fs::path file = fs::path(::testing::TempDir()) / ("grouser_again_" + std::to_string(getpid()));
  support::FileLock first, second;
  ASSERT_TRUE(first.take(file));
  fs::remove(file);
  EXPECT_TRUE(second.take(file));
  EXPECT_TRUE(fs::exists(file));
  EXPECT_TRUE(support::FileLock::isTaken(file));
  first.release(), second.release();
  fs::remove(file);
}

TEST(FileLock, IsHeldByOneAtATime) {
  const fs::path file = fs::path(::testing::TempDir()) / ("grouser_lock_" + std::to_string(getpid()));
  support::FileLock second;
  {
    support::FileLock first;
    EXPECT_TRUE(first.take(file));
    EXPECT_TRUE(first.take(file)) << "it is mine";
    EXPECT_FALSE(second.take(file));
  }
  EXPECT_TRUE(second.take(file));
  fs::remove(file);
}

} // namespace
} // namespace grouser::storage
