// SPDX-License-Identifier: BSD-3-Clause
// The surface of a scene's height-map, and the notes and warnings about it before a run.
#include "runs/setup/bed_options.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"

#include "base/error.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/scene_file.hpp"
#include "tests/png_fixture.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
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
  static scene::Scene bed(const std::string& more, const char* map = "heightmaps/step.png", double height = 0.12) {
    return parseScene("version = 1\n[run]\nduration = 1\n[material.soil]\nstiffness = 1e5\nfriction = 0.4\n"
                      "[terrain]\nheightmap = \"" +
                          std::string(map) + "\"\nsize = [0.8, 0.8]\nheight_range = [0, " + std::to_string(height) +
                          "]\nmaterial = \"soil\"\ngrain_radius = 0.02\ndepth = 0.1\n" + more,
                      "bed.toml");
  }
  std::string written(const char* name, const std::string& bytes) {
    std::string file = (folder_ / name).string();
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
  /// A level picture of 61 x 61 pixels, some 13 mm apart in bed(), with one white pixel raised by `height` [m].
  scene::Scene spike(double height, const std::string& more) {
    std::vector<int> pixels(61 * 61);
    pixels[30 * 61 + 20] = 255;
    const std::string file = written("spike.png", pngs::png(61, 61, 8, pngs::kGrey, pixels));
    return bed(more, file.c_str(), height);
  }
  std::filesystem::path folder_;
};

TEST_F(TerrainNotes, SteepEdgeUnderABedThatFollowsIt_IsWarnedOf) {
  const std::vector<std::string> warnings = terrainRemarks(bed("")).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  for (const char* part : {"step.png", "m/m", "degrees", ") m", "terrain.floor = \"flat\""})
    EXPECT_NE(warnings.front().find(part), std::string::npos) << warnings.front();
  EXPECT_TRUE(terrainRemarks(bed("floor = \"flat\"\n")).warnings.empty());
  EXPECT_TRUE(terrainRemarks(bed("", "heightmaps/hills.png")).warnings.empty());
}

TEST_F(TerrainNotes, SinglePixelsAreWarnedOfBySlopeAtTheirSides) {
  const double spacing = 0.8 / 60;
  for (const double slope : {1.9, 2.1, 2.5, 2.8, 4.0})
    for (const bool cubic : {true, false}) {
      // Midway between two pixels a cubic is 3/2 as steep as the line; bilinear cells slope both ways at the top.
      const double height = slope * spacing / (cubic ? 1.5 : std::sqrt(2.0));
      const TerrainRemarks remarks = terrainRemarks(spike(height, cubic ? "" : "interpolation = \"bilinear\"\n"));
      ASSERT_EQ(remarks.warnings.size(), slope > 2 ? 1u : 0u) << slope;
      if (slope < 2) continue;
      const std::string rise = fmt::format("slope of {:.3g} m/m", slope);
      EXPECT_NE(remarks.warnings.front().find(rise), std::string::npos) << remarks.warnings.front();
    }
}

TEST_F(TerrainNotes, EdgesOfASmallPartOfARadiusAreNotWarnedOf) {
  // Pixel spacing for a spike's slope of 3, at any height.
  const auto warnings = [&](double height) {
    scene::Scene scene = spike(height, "");
    scene.terrain->size = {0.8 * height / 0.0267, 0.8 * height / 0.0267};
    return terrainRemarks(scene).warnings.size();
  };
  EXPECT_EQ(warnings(0.02 * 0.02), 0u);
  EXPECT_EQ(warnings(0.15 * 0.02), 1u);
}

TEST_F(TerrainNotes, ColourIsNoted) {
  const std::string file =
      written("colour.png", pngs::png(2, 2, 8, pngs::kRgb, {255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 255}));
  const std::vector<std::string> notes = terrainRemarks(bed("", file.c_str())).notes;
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes.front().find("colour.png is a colour image"), std::string::npos) << notes.front();
  EXPECT_NE(notes.front().find("luminance"), std::string::npos);
  EXPECT_TRUE(terrainRemarks(bed("")).notes.empty());
}

TEST_F(TerrainNotes, InterpolationIsMonotoneUnlessTheSceneSaysOtherwise) {
  const auto highest = [](const std::string& more) { return readSurface(bed(more)).bounds().highest; };
  // The picture's step is smaller than the range of its format.
  EXPECT_EQ(highest(""), highest("interpolation = \"bilinear\"\n"));
  EXPECT_GT(highest("interpolation = \"smooth\"\n"), highest("") + 4e-4);
  EXPECT_THROW(bed("interpolation = \"cubic\"\n"), base::InputError);
}

TEST_F(TerrainNotes, OtherInterpolationIsAnotherBed) {
  EXPECT_NE(bedOrigin(bed(""), 1e-5), bedOrigin(bed("interpolation = \"smooth\"\n"), 1e-5));
}

/// A vehicle on deformable soil with the shape of a map of assets/heightmaps.
scene::Scene drive(const std::string& map, const std::string& size, const std::string& heights) {
  return parseScene("version = 1\n[run]\nduration = 1\n[material.ground]\n[scm]\nn = 1.1\nk_c = 990\nk_phi = 1.5e6\n"
                    "c = 1040\nphi = 28\nK = 0.025\n[terrain]\nheightmap = \"heightmaps/" +
                        map + "\"\nsize = " + size + "\nheight_range = " + heights +
                        "\nmaterial = \"ground\"\nkind = \"scm\"\n[vehicle]\nspec = \"vehicles/light_tracked.toml\"\n" +
                        "[driver]\nsprocket_speed = 1.0\n",
                    "drive.toml");
}

std::string notesOf(const scene::Scene& scene) {
  std::string all;
  for (const std::string& note : terrainRemarks(scene).notes) all += note + "\n";
  return all;
}

TEST(MapNotes, ReliefThatCannotBeMeantIsNoted) {
  const std::string high = notesOf(drive("hills.png", "[20, 10]", "[0, 500]"));
  EXPECT_NE(high.find("terrain.height_range = [0, 500] m results in a relief of"), std::string::npos) << high;
  EXPECT_NE(high.find("in millimetres? set height_range = [0, 0.5]"), std::string::npos) << high;
  EXPECT_NE(notesOf(drive("hills.png", "[20, 10]", "[0, 100]")).find("in millimetres? set height_range = [0, 0.1]"),
            std::string::npos);
  EXPECT_EQ(notesOf(drive("hills.png", "[20, 10]", "[0, 1]")), "");
  EXPECT_EQ(notesOf(drive("hills.png", "[20, 10]", "[1000, 1000.2]")), "") << "an offset does not matter";
  for (const char* heights : {"[0, 5]", "[1000, 1005]", "[-5, 0]"}) { // 5 mm or 5 cm on 10 m is no relief to enter
    const std::string steep = notesOf(drive("hills.png", "[10, 4]", heights));
    EXPECT_NE(steep.find("correct height_range or size (usual is a relief of at most 0.8 m"), std::string::npos)
        << steep;
  }
  EXPECT_EQ(notesOf(drive("step.png", "[20, 10]", "[0, 1]")), "") << "a steep step is no steep terrain";
}

TEST(MapNotes, StretchedPixelsAreNoted) {
  const std::string stretched = notesOf(drive("hills.png", "[90, 10]", "[0, 1]"));
  EXPECT_NE(stretched.find("terrain.size = [90, 10] m stretches the map of"), std::string::npos) << stretched;
  EXPECT_NE(stretched.find("along x; set size to the proportions of the map"), std::string::npos) << stretched;
  EXPECT_NE(notesOf(drive("hills.png", "[10, 20]", "[0, 1]")).find("along y;"), std::string::npos);
  EXPECT_EQ(notesOf(drive("step.png", "[90, 10]", "[0, 0.1]")), "") << "varies along x only";
  EXPECT_EQ(notesOf(drive("flat.png", "[90, 10]", "[0, 0]")), "");
}

TEST(MapNotes, HeightStepsOfEightBitsAreNotedIfTheyAreCoarseForTheGround) {
  const std::string coarse = notesOf(drive("hills8.png", "[40, 20]", "[0, 5]"));
  EXPECT_NE(coarse.find("has 8 bits, so height_range = [0, 5] m results in height steps of 19.6 mm, above a fifth of "
                        "the node spacing"),
            std::string::npos)
      << coarse;
  EXPECT_NE(coarse.find("save the map with 16 bits, or reduce the range"), std::string::npos);
  EXPECT_EQ(notesOf(drive("hills8.png", "[40, 20]", "[0, 0.5]")), "");
  EXPECT_EQ(notesOf(drive("hills.png", "[40, 20]", "[0, 5]")), "") << "16 bits";
}

TEST(MapNotes, ScenesOfTheRepositoryHaveNone) {
  int maps = 0;
  for (const char* folder : {"runs/scenes", "docs/evidence"})
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(GROUSER_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".toml") continue;
      const scene::Scene scene = scene::readScene(entry.path());
      if (!scene.terrain) continue;
      ++maps;
      EXPECT_EQ(notesOf(scene), "") << entry.path();
    }
  EXPECT_GT(maps, 25);
}

} // namespace
} // namespace grouser::setup
