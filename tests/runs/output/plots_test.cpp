// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/plots.hpp"
#include "runs/setup/load_scene.hpp"

#include "runs/output/channels.hpp"
#include "runs/output/output.hpp"
#include "runs/setup/provenance.hpp"
#include "tests/runs/folder_fixture.hpp"
#include "tests/runs/row_builder.hpp"
#include "tests/runs/scene_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace grouser::output {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

constexpr int kShoes = 12, kRows = 80;

/// Three panels of figure.png: a column against time, a component against another, and the sum of two.
const std::string kPanels = R"([[output.plot]]
title = "Speed"
y = ["vehicle.left.speed"]
y_label = "speed [m/s]"
levels = [0.2]
level_labels = ["wanted"]
[[output.plot]]
x = "vehicle.position.x"
x_from_start = true
y = ["vehicle.position.z", "vehicle.left.speed"]
labels = ["sum"]
sum = true
y_label = "sum"
)";

/// A passing track: shoe s has ground contact until row 10 + 5 s, sinks during it, and then rises. The last shoe
/// touches down only at row 60.
class Plots : public FolderTest {
protected:
  void SetUp() override {
    FolderTest::SetUp();
    std::vector<Channel> channels = {
        {"vehicle/left/sinkage", "m", "", kShoes, {}},    {"vehicle/left/pad_height", "m", "", kShoes, {}},
        {"vehicle/left/tension", "N", "", kShoes, {}},    {"vehicle/left/sprocket_speed", "rad/s", "", 1, {}},
        {"vehicle/left/speed", "m/s", "", 1, {}},         {"vehicle/left/drive_torque", "N m", "", 1, {}},
        {"vehicle/position", "m", "", 3, {"x", "y", "z"}}};
    const std::vector<Channel> ledger = ledgerColumns().channels();
    channels.insert(channels.end(), ledger.begin(), ledger.end());
    RunWriter writer(
        folder_,
        setup::provenanceOf(setup::parseScene(goodScene() + kPanels, std::string(GROUSER_SOURCE_DIR) + "/scene.toml")),
        channels, {});
    writer.constant(output::kPitchRadius, 0.245);
    writer.surface({{0, 1, 2}, {-1, 1}, {0, 0.1, 0.2, 0.1, 0.2, 0.3}, "bilinear"});
    terrain::BedStructure bed;
    bed.porosity = 0.4, bed.depth = {0.1, 0.3}, bed.porosityAtDepth = {0.5, 0.4};
    bed.distance = {0.5, 1.5}, bed.radialDistribution = {0, 1.1};
    writer.bed(bed);
    RowBuilder row(channels);
    for (int r = 0; r < kRows; ++r) {
      std::vector<double> sinkage(kShoes), height(kShoes);
      for (int s = 0; s < kShoes; ++s) {
        const auto i = static_cast<std::size_t>(s);
        const int left = 10 + 5 * s - r;
        sinkage[i] = left >= 0 && (s + 1 < kShoes || r >= 60) ? 0.001 * r : std::nan("");
        height[i] = left >= 0 ? 0.2 - 0.001 * r : 0.2 - 0.05 * left;
      }
      row.begin(r, 0.02 * r);
      row.set("vehicle/left/sinkage", sinkage);
      row.set("vehicle/left/pad_height", height);
      row.set("vehicle/left/tension", std::vector<double>(kShoes, 5000));
      row.set("vehicle/left/sprocket_speed", 1.0);
      row.set("vehicle/left/speed", 0.24);
      row.set("vehicle/position", base::Vec3d{0.005 * r, 0, 0.5});
      row.set("vehicle/left/drive_torque", 300.0);
      for (const Channel& c : ledger)
        if (c.width == 1) row.set(c.path, 1.0 * r);
      writer.row(row.row());
    }
    writer.finish({});
  }
  void TearDown() override {
    unsetenv("GROUSER_SHARE");
    FolderTest::TearDown();
  }
};

TEST_F(Plots, AreDrawnOrSayWhatToInstall) {
  std::string warning;
  const std::vector<fs::path> drawn = drawPlots(folder_ / "results.h5", folder_, kAllPlots, warning);
  if (!warning.empty()) {
    EXPECT_NE(warning.find("install python3"), std::string::npos) << warning;
    GTEST_SKIP() << warning;
  }
  ASSERT_EQ(drawn.size(), kAllPlots.size() - 1) << "all except that of mechanisms, which these results lack";
  for (const fs::path& plot : drawn) EXPECT_GT(fs::file_size(plot), 10000u) << plot;
}

TEST_F(Plots, SingleShoesAreDrawnWithAControlBehindThem) {
  const fs::path alone = folder_ / "alone.png", both = folder_ / "both.png", results = folder_ / "results.h5";
  drawPicture("single_shoes.py", {results, "2,3,5"}, alone);
  drawPicture("single_shoes.py", {results, results, "2,3,5"}, both);
  if (std::string warning; drawPlots(results, folder_, {"sinkage"}, warning).empty()) GTEST_SKIP() << warning;
  EXPECT_GT(fs::file_size(alone), 10000u);
  EXPECT_GT(fs::file_size(both), fs::file_size(alone));
}

TEST_F(Plots, WithoutAShoeOnTheGroundRunAreDrawnEmpty) {
  const fs::path hanging = folder_ / "hanging";
  const std::vector<Channel> channels = {{"vehicle/left/sinkage", "m", "", kShoes, {}},
                                         {"vehicle/left/pad_height", "m", "", kShoes, {}}};
  {
    RunWriter writer(
        hanging, setup::provenanceOf(setup::parseScene(goodScene(), std::string(GROUSER_SOURCE_DIR) + "/scene.toml")),
        channels, {});
    RowBuilder row(channels);
    row.begin(0, 0); // all NaN
    writer.row(row.row());
    writer.finish({});
  } // closes the file
  std::string warning;
  const std::vector<fs::path> drawn = drawPlots(hanging / "results.h5", hanging, {"sinkage", "shoe_heights"}, warning);
  if (warning.find("install python3") != std::string::npos) GTEST_SKIP() << warning;
  EXPECT_EQ(warning, "");
  EXPECT_EQ(drawn.size(), 2u);
}

TEST_F(Plots, WithoutScriptsAreAWarning) {
  setenv("GROUSER_SHARE", "/nonexistent", 1);
  std::string warning;
  EXPECT_TRUE(drawPlots(folder_ / "results.h5", folder_, kAllPlots, warning).empty());
  EXPECT_NE(warning.find("GROUSER_SHARE"), std::string::npos);
}

TEST_F(Plots, OfADamagedFileAreAWarning) {
  std::string warning;
  EXPECT_TRUE(drawPlots(folder_ / "timeseries.csv", folder_, kAllPlots, warning).empty());
  EXPECT_NE(warning.find("no plots"), std::string::npos);
}

/// The four shoes of the source paper's figure: neighbours, longest in ground contact, then picked up during the run.
TEST_F(Plots, FourShoesAreConsecutiveAndPickedUp) {
  const std::string script = "import sys; sys.path.insert(0, '" + std::string(GROUSER_SOURCE_DIR) +
                             "/runs/plots'); import h5py, series, shoes; run = series.Run(h5py.File('" +
                             (folder_ / "results.h5").string() +
                             "', 'r')); side, four = shoes.choose_four(run.shoes('pad_height'), run.shoes('sinkage')); "
                             "sys.exit(0 if (side, four) == ('left', [7, 8, 9, 10]) else print(side, four) or 9)";
  const int status = std::system(("/usr/bin/python3 -c \"" + script + "\"").c_str());
  if (WEXITSTATUS(status) != 0 && WEXITSTATUS(status) != 9) GTEST_SKIP() << "no Python with h5py and matplotlib";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

} // namespace
} // namespace grouser::output
