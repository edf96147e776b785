// SPDX-License-Identifier: BSD-3-Clause
// Floors with hollows tighter than the grains: their count towards the limit of boundaries, and their memory.
#include "base/error.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/grain_memory.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/load_scene.hpp"
#include "terrain/grain_constants.hpp"
#include "tests/message_of.hpp"
#include "tests/png_fixture.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace grouser::setup {
namespace {

using test::messageOf;

class FloorPlaces : public ::testing::Test {
protected:
  /// A V of 45 degrees along y, with pixels 10 mm apart.
  void SetUp() override {
    std::vector<int> pixels;
    for (int row = 0; row < 41; ++row)
      for (int column = 0; column < 41; ++column) pixels.push_back(std::abs(column - 20) * 12);
    file_ = std::filesystem::temp_directory_path() /
            (std::string("grouser_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".png");
    std::ofstream(file_, std::ios::binary) << pngs::png(41, 41, 8, pngs::kGrey, pixels);
  }
  void TearDown() override { std::filesystem::remove(file_); }

  /// `more`: lines of [terrain], and boxes above it.
  scene::Scene valley(double height, int boxes, const std::string& more = "kind = \"rigid\"") const {
    std::string text = fmt::format("version = 1\n[run]\nduration = 1\n[material.soil]\nstiffness = 1e5\nfriction = "
                                   "0.4\n[terrain]\nheightmap = \"{}\"\nsize = [0.4, 0.4]\nheight_range = [0, {}]\n"
                                   "material = \"soil\"\n{}\n[[grain]]\nposition = [0.2, 0, 0.6]\nradius = 0.02\n"
                                   "material = \"soil\"\n",
                                   file_.string(), height, more);
    for (int k = 0; k < boxes; ++k)
      text += fmt::format("[[box]]\nposition = [0.2, 0, {}]\nsize = [0.1, 0.1, 0.05]\nmaterial = \"soil\"\n", 1 + k);
    return parseScene(text, "scene.toml");
  }
  static constexpr double kHeight = 0.2125; ///< [m] of white: 10 mm are 12 levels
  std::filesystem::path file_;
};

TEST_F(FloorPlaces, ManyContactsWithTheFloorCountToTheLimitOfBoundaries) {
  EXPECT_EQ(messageOf([&] { groundSetup(valley(kHeight, 24), 1e-5); }), "");
  const std::string message = messageOf([&] { valley(kHeight, 25); });
  for (const char* part :
       {"scene.toml:", "box.24", "is one of 33 or more", "the floor counts as 8", "at most 32", "remove some"})
    EXPECT_NE(message.find(part), std::string::npos) << part << " in " << message;
  // Shallow hollows have one contact.
  EXPECT_EQ(messageOf([&] { groundSetup(valley(0.001, 25), 1e-5); }), "");
}

TEST_F(FloorPlaces, FlatFloorBelowABedCountsAsOne) {
  const std::string bed = "grain_radius = 0.02\ndepth = 0.1\nwalls = false\n";
  EXPECT_NE(messageOf([&] { valley(kHeight, 25, bed); }).find("or set terrain.floor = \"flat\""), std::string::npos);
  EXPECT_EQ(messageOf([&] { valley(kHeight, 25, bed + "floor = \"flat\"\n"); }), "");
}

TEST_F(FloorPlaces, PlannedMemoryHasTheSpringsOfTheRun) {
  const auto springs = [](const scene::Scene& scene) {
    const coupling::GroundSetup ground = groundSetup(scene, 1e-5);
    return terrain::GrainConstants(ground.grains->model, ground.grains->boundaries, {}).springsWidth();
  };
  const scene::Scene hollow = valley(kHeight, 2), gentle = valley(0.001, 2);
  ASSERT_EQ(springs(hollow), 10u * 3 + 8 * 3); // springs of 8 places and 2 boxes, normals of 8 places
  ASSERT_EQ(springs(gentle), 3u * 3);
  // A single grain may be anywhere: the whole floor counts.
  EXPECT_EQ(grainMemory(hollow).boundaries - grainMemory(gentle).boundaries, sizeof(float) * (54 - 9));
}

} // namespace
} // namespace grouser::setup
