// SPDX-License-Identifier: BSD-3-Clause
// Sphere sets in the cache: bitwise equal to a new conversion, and never a cause of failed runs.
#include "runs/storage/sphere_cache.hpp"

#include "base/error.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/runs/folder_fixture.hpp"
#include "tests/spheredecomp/shapes.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

namespace grouser::storage {

using namespace grouser::test; // fixtures

namespace {

namespace fs = std::filesystem;
namespace shapes = spheredecomp::shapes;

const base::TriangleMesh& cylinder() {
  static const base::TriangleMesh mesh = shapes::cylinder(0.1, 0.15, 32);
  return mesh;
}

class KeptSpheres : public FolderTest {
protected:
  void SetUp() override {
    FolderTest::SetUp();
    fs::remove(folder_); // the first set creates it
  }

  SphereCache cache(std::uint64_t limit = support::KeptFiles::kDefaultLimit) const {
    return SphereCache(support::KeptFiles(folder_, limit));
  }
  /// A new cache's set and its message.
  std::pair<base::SphereSet, std::string> cut(const coupling::PartCut& part) const {
    SphereCache c = cache();
    base::SphereSet set = c.cut(part);
    return {set, c.summary()};
  }
  static coupling::PartCut part(double radius = 0.012, const std::string& name = "drum") {
    return {&cylinder(), name, {.radius = radius}};
  }
  static base::SphereSet cutAlone(const coupling::PartCut& p) {
    return spheredecomp::decompose(*p.mesh, p.name, p.options);
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder_))
      if (entry.path().extension() == ".bin") found.push_back(entry.path());
    return found;
  }
};

void expectSame(const base::SphereSet& a, const base::SphereSet& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.surfaceCount, b.surfaceCount);
  EXPECT_EQ(a.spacing, b.spacing);
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.meshVolume, b.meshVolume);
  EXPECT_EQ(a.meshArea, b.meshArea);
  ASSERT_EQ(a.spheres.size(), b.spheres.size());
  EXPECT_EQ(std::memcmp(a.spheres.data(), b.spheres.data(), a.spheres.size() * sizeof(base::SetSphere)), 0);
}

bool wasCut(const std::string& summary) { return summary.find(" converted to spheres in ") != std::string::npos; }

TEST_F(KeptSpheres, AreThoseThatWouldBeCut) {
  const base::SphereSet alone = cutAlone(part());
  const auto [first, says] = cut(part());
  const auto [second, saysThen] = cut(part());
  expectSame(first, alone), expectSame(second, alone);
  EXPECT_EQ(says.rfind("1 mesh converted to spheres in ", 0), 0u) << says;
  EXPECT_NE(says.find("cached in " + folder_.string()), std::string::npos) << says;
  EXPECT_EQ(saysThen.rfind("1 sphere set read from " + folder_.string(), 0), 0u) << saysThen;
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(KeptSpheres, LookUpOnlyCutsNothing) {
  storage::SphereCache kept{support::KeptFiles(folder_)};
  kept.lookUpOnly();
  EXPECT_THROW(kept.cut(part()), storage::SphereCache::NotKept);
  EXPECT_FALSE(std::filesystem::exists(folder_)) << "nothing is written";
  cut(part());
  expectSame(kept.cut(part()), cutAlone(part()));
}

TEST_F(KeptSpheres, HaveTheNameOfThePartThatAsks) {
  cut(part());
  const coupling::PartCut other = part(0.012, "roller");
  const auto [set, says] = cut(other);
  EXPECT_FALSE(wasCut(says));
  expectSame(set, cutAlone(other));
}

TEST_F(KeptSpheres, OfOtherRadiusOptionOrMeshAreCutAnew) {
  cut(part());
  const base::TriangleMesh longer = shapes::cylinder(0.1, std::nextafter(0.15, 1), 32);
  coupling::PartCut hollow = part(), stretched = part();
  hollow.options.interior = false, stretched.mesh = &longer;
  for (const coupling::PartCut& p : {part(std::nextafter(0.012, 1)), hollow, stretched}) {
    EXPECT_TRUE(wasCut(cut(p).second));
    const auto [set, says] = cut(p);
    EXPECT_FALSE(wasCut(says));
    expectSame(set, cutAlone(p));
  }
  EXPECT_EQ(files().size(), 4u);
}

TEST_F(KeptSpheres, DamagedOrForeignFileIsToldAndCutAnew) {
  const base::SphereSet alone = cutAlone(part());
  cut(part());
  const fs::path file = files().at(0);
  const std::string whole = contents(file);
  std::string flipped = whole;
  flipped[whole.size() / 2] = static_cast<char>(flipped[whole.size() / 2] ^ 4);
  std::string version = whole;
  version.replace(version.find("version 2"), 9, "version 9");
  for (const std::string& bad :
       {flipped, version, whole.substr(0, whole.size() - 1), whole + "x", std::string("no set"), std::string()}) {
    put(file, bad);
    ::testing::internal::CaptureStderr();
    const auto [set, says] = cut(part());
    const std::string printed = ::testing::internal::GetCapturedStderr();
    EXPECT_EQ(printed.rfind("WARNING: " + file.string(), 0), 0u) << printed;
    EXPECT_EQ(printed.find("WARNING", 1), std::string::npos) << "one message: " << printed;
    EXPECT_TRUE(wasCut(says)) << says;
    expectSame(set, alone);
    EXPECT_FALSE(wasCut(cut(part()).second)) << "a new set replaces the damaged one";
  }
}

TEST_F(KeptSpheres, OfAnotherOriginAreNotTaken) {
  cut(part(0.012));
  const fs::path one = files().at(0);
  fs::rename(one, folder_ / "kept");
  cut(part(0.013));
  fs::rename(folder_ / "kept", files().at(0)); // as if two origins had one hash
  ::testing::internal::CaptureStderr();
  const auto [set, says] = cut(part(0.013));
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("do not match the file name"), std::string::npos);
  EXPECT_TRUE(wasCut(says));
  expectSame(set, cutAlone(part(0.013)));
}

TEST_F(KeptSpheres, UnusableFolderEndsNoRun) {
  put(folder_, "a file where the folder should be");
  const auto [set, says] = cut(part());
  expectSame(set, cutAlone(part()));
  EXPECT_NE(says.find("; not cached"), std::string::npos) << says;
}

TEST_F(KeptSpheres, ShareTheirLimitWithBedsAndTheOldestGo) {
  const auto now = fs::file_time_type::clock::now();
  cut(part(0.012));
  const fs::path first = files().at(0);
  cut(part(0.0121));
  ASSERT_EQ(files().size(), 2u);
  std::uintmax_t two = 0;
  for (const fs::path& file : files())
    two += fs::file_size(file), fs::last_write_time(file, now - std::chrono::hours(file == first ? 3 : 2));
  cut(part(0.012)); // now the oldest is the most recently used
  put(folder_ / "bed-0123456789abcdef.h5", std::string(1000, 'b'));
  fs::last_write_time(folder_ / "bed-0123456789abcdef.h5", now - std::chrono::hours(1));
  put(folder_ / "mine.bin", "not of this program: stays");
  put(folder_ / "spheres-0.bin.host.1.part", "left by a killed run");
  fs::last_write_time(folder_ / "spheres-0.bin.host.1.part", now - std::chrono::hours(25));
  SphereCache room = cache(two + two / 4); // two sets and the bed, or three sets less the oldest
  room.cut(part(0.0122));
  EXPECT_FALSE(wasCut(cut(part(0.012)).second));
  EXPECT_FALSE(wasCut(cut(part(0.0122)).second));
  EXPECT_TRUE(fs::exists(folder_ / "bed-0123456789abcdef.h5")) << "newer than the removed set";
  EXPECT_TRUE(fs::exists(folder_ / "mine.bin"));
  EXPECT_FALSE(fs::exists(folder_ / "spheres-0.bin.host.1.part"));
  EXPECT_TRUE(wasCut(cut(part(0.0121)).second)) << "the least recently used set is removed, and converted again";

  cache(1).cut(part(0.0123));
  EXPECT_TRUE(wasCut(cut(part(0.0123)).second)) << "exceeds the limit";
  cache(two * 3 / 4).cut(part(0.0124)); // space for one set
  EXPECT_FALSE(fs::exists(folder_ / "bed-0123456789abcdef.h5")) << "a set displaces an older bed";
}

TEST_F(KeptSpheres, SecondProgramWaitsForTheFirst) {
  std::string a, b;
  std::thread first([&] { a = cut(part(0.008)).second; });
  std::thread second([&] { b = cut(part(0.008)).second; });
  first.join(), second.join();
  EXPECT_EQ(wasCut(a) + wasCut(b), 1) << a << "\n" << b;
}

TEST_F(KeptSpheres, ErrorsOfTheCutAreThoseWithoutCache) {
  SphereCache c = cache();
  EXPECT_THROW(c.cut(part(5)), base::InputError);
  EXPECT_EQ(files().size(), 0u);
  EXPECT_EQ(c.summary(), "");
}

TEST_F(KeptSpheres, RunsHaveTheStatesOfRunsWithoutCache) {
  const auto vehicle = [] {
    return setup::loadScene(
        std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/rigid.toml",
        {"vehicle.sphere_radius=0.04", "vehicle.clearance=0", "vehicle.gear_contact_model=samples"});
  };
  put(folder_.string() + ".obj", "v 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nv 0 0 0.2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const auto mesh = [this] {
    return setup::parseScene("version = 1\n[run]\nduration = 0.1\ntime_step = 2e-4\n[material.soil]\nstiffness = 1e5\n"
                             "restitution = 0.2\n[[mesh]]\nfile = \"" +
                                 folder_.string() + ".obj\"\nposition = [0, 0, 0]\nmaterial = \"soil\"\n" +
                                 "sphere_radius = 0.01\n[[grain]]\nposition = [0.03, 0.03, 0.205]\nradius = 0.03\n"
                                 "material = \"soil\"\n",
                             "mesh.toml", {});
  };
  const auto hashOf = [](const scene::Scene& scene, SphereCache* kept) {
    coupling::Simulation simulation(
        setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {}, {}, nullptr, kept);
    while (simulation.steps() < 50) simulation.step();
    std::string straight = simulation.stateHash();
    if (!kept) return straight;
    coupling::Simulation resumed(setup::simulationSetup(scene), base::cpuExec(1), simulation.save(), {}, kept);
    EXPECT_EQ(resumed.stateHash(), straight);
    return straight;
  };
  for (const scene::Scene& scene : {vehicle(), mesh()}) {
    const std::string without = hashOf(scene, nullptr);
    for (int time = 0; time < 2; ++time) {
      SphereCache c = cache();
      EXPECT_EQ(hashOf(scene, &c), without);
      EXPECT_EQ(wasCut(c.summary()), time == 0) << c.summary();
      EXPECT_NE(c.summary().find("read from"), std::string::npos) << "a resumed run has its sets: " << c.summary();
    }
  }
  EXPECT_EQ(files().size(), 7u) << "five parts and a hull with sampled contacts, and the mesh";
  fs::remove(folder_.string() + ".obj");
}

} // namespace
} // namespace grouser::storage
