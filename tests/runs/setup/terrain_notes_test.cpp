// SPDX-License-Identifier: BSD-3-Clause
// The surface of a scene's height-map, and the notes and warnings about it before a run.
#include "runs/setup/bed_options.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace grouser::setup {
namespace {

class TerrainNotes : public ::testing::Test {
protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("grouser_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// A scene with a bed on assets/heightmaps/step.png.
  static scene::Scene bed(const std::string& more, const char* map = "heightmaps/step.png") {
    return parseScene("version = 1\n[run]\nduration = 1\n[material.soil]\nstiffness = 1e5\nfriction = 0.4\n"
                      "[terrain]\nheightmap = \"" +
                          std::string(map) +
                          "\"\nsize = [0.8, 0.8]\nheight_range = [0, 0.12]\nmaterial = \"soil\"\ngrain_radius = 0.02\n"
                          "depth = 0.1\n" +
                          more,
                      "bed.toml");
  }
  std::filesystem::path folder_;
};

TEST_F(TerrainNotes, SteepEdgeUnderABedThatFollowsIt_IsWarnedOf) {
  const std::vector<std::string> warnings = terrainWarnings(bed(""));
  ASSERT_EQ(warnings.size(), 1u);
  for (const char* part : {"step.png", "m a metre", "degrees", ") m", "terrain.floor = \"flat\""})
    EXPECT_NE(warnings.front().find(part), std::string::npos) << warnings.front();
  EXPECT_TRUE(terrainWarnings(bed("floor = \"flat\"\n")).empty());
  EXPECT_TRUE(terrainWarnings(bed("", "heightmaps/hills.png")).empty());
}

TEST_F(TerrainNotes, ColourIsNoted) {
  // Red, black, black, blue.
  const unsigned char picture[] = {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
                                   0x44, 0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x02, 0x00, 0x00,
                                   0x00, 0xfd, 0xd4, 0x9a, 0x73, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x44, 0x41, 0x54, 0x78,
                                   0xda, 0x63, 0xf8, 0xcf, 0x80, 0x00, 0xff, 0x01, 0x0e, 0x00, 0x01, 0xff, 0xe7, 0x01,
                                   0x62, 0x0a, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  const std::string file = (folder_ / "colour.png").string();
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(picture), sizeof picture);
  const std::vector<std::string> notes = terrainNotes(bed("", file.c_str()));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes.front().find("colour.png is a picture in colour"), std::string::npos) << notes.front();
  EXPECT_NE(notes.front().find("luminance"), std::string::npos);
  EXPECT_TRUE(terrainNotes(bed("")).empty());
}

TEST_F(TerrainNotes, InterpolationIsMonotoneUnlessTheSceneSaysOtherwise) {
  const auto highest = [](const std::string& more) { return readSurface(bed(more)).bounds().highest; };
  // The picture's step is less than its format's range.
  EXPECT_EQ(highest(""), highest("interpolation = \"bilinear\"\n"));
  EXPECT_GT(highest("interpolation = \"smooth\"\n"), highest("") + 4e-4);
  EXPECT_THROW(bed("interpolation = \"cubic\"\n"), base::InputError);
}

TEST_F(TerrainNotes, OtherInterpolationIsAnotherBed) {
  EXPECT_NE(bedOrigin(bed(""), 1e-5), bedOrigin(bed("interpolation = \"smooth\"\n"), 1e-5));
}

} // namespace
} // namespace grouser::setup
