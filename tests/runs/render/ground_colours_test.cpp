// SPDX-License-Identifier: BSD-3-Clause
// Colours of deformable soil.
#include "runs/render/ground_colours.hpp"

#include "base/error.hpp"
#include "runs/output/frames_file.hpp"
#include "runs/render/frame_painter.hpp"
#include "runs/render/render.hpp"

#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

namespace grouser::render::ground_colours {
namespace {

/// A square of soil; stresses on its right half.
output::StoredFrame square() {
  auto soil = std::make_shared<output::SoilSurface>();
  soil->mesh.vertices = {{-1, -1, 0}, {0, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {0, 1, 0}, {1, 1, 0}};
  soil->mesh.indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
  soil->sinkage = {0, 0, 0.04f, 0, 0, 0.04f};
  soil->pressure = soil->maxPressure = {0, 0, 5e4f, 0, 0, 5e4f};
  soil->shear.resize(6);
  soil->shear[2] = soil->shear[5] = {3e3f, 4e3f, 0};
  output::StoredFrame frame;
  frame.soil = soil;
  return frame;
}

TEST(GroundColours, RunFromSoilWithoutALoadToTheMaximum) {
  const output::StoredFrame frame = square();
  for (const auto& [word, high, title] : {std::tuple{"sinkage", 40.0, "sinkage [mm]"},
                                          {"pressure", 50.0, "pressure [kPa]"},
                                          {"shear", 5.0, "shear [kPa]"}}) {
    const GroundColours colours(*groundQuantity(word), {frame}, {});
    EXPECT_NEAR(colours.shownRange().high, high, 1e-5) << word;
    EXPECT_EQ(colours.shownRange().low, 0);
    EXPECT_EQ(colours.title(), title);
    const RenderMesh mesh = colours.mesh(*frame.soil);
    ASSERT_EQ(mesh.vertexColours.size(), 6u);
    EXPECT_EQ(mesh.vertexColours[0].x, groundColour().x) << "soil keeps its colour";
    EXPECT_EQ(mesh.vertexColours[2].x, heightColour(1).x);
  }
  const GroundColours half(GroundQuantity::Pressure, {frame}, ValueRange{0, 1e5});
  EXPECT_EQ(half.mesh(*frame.soil).vertexColours[2].x, heightColour(0.5f).x);
  EXPECT_FALSE(groundQuantity("depth"));
  EXPECT_LT(GroundColours().mesh(*frame.soil).vertexColours[2].x, groundColour().x) << "pressed soil is darker";
}

TEST(GroundColours, ColoursOfVerticesAppearInThePicture) {
  const output::StoredFrame frame = square();
  RenderScene scene;
  scene.meshes.push_back(GroundColours(GroundQuantity::Pressure, {frame}, {}).mesh(*frame.soil));
  Camera above;
  above.eye = {0, -0.01, 4}, above.target = {0, 0, 0};
  constexpr int kWidth = 120, kHeight = 90;
  const Image image = render(scene, above, kWidth, kHeight);
  const std::uint8_t *left = image.at(kWidth / 2 - 20, kHeight / 2), *right = image.at(kWidth / 2 + 32, kHeight / 2);
  EXPECT_GT(right[1], right[2] + 60) << "yellow at the maximum";
  EXPECT_LT(left[1], left[2] + 60) << "soil on the left";
  // The colour of a mesh without vertex colours does not change.
  scene.meshes.push_back({{{{-1, -1, 0.1}, {0, -1, 0.1}, {0, 1, 0.1}}, {0, 1, 2}}, {}, {0, 0, 0.8f}, false, {}});
  const Image both = render(scene, above, kWidth, kHeight);
  const std::uint8_t* blue = both.at(kWidth / 2 - 10, kHeight / 2);
  EXPECT_GT(blue[2], 2 * blue[0]);
}

using GroundColoursOfFrames = test::FolderTest;

TEST_F(GroundColoursOfFrames, AreSeenThroughTheVehicle) {
  const base::TriangleMesh hull{{{-1, -1, 0.5}, {1, -1, 0.5}, {1, 1, 0.5}, {-1, 1, 0.5}}, {0, 1, 2, 0, 2, 3}};
  output::Frame frame;
  frame.partPoses = {{}};
  const auto painted = [&](GroundQuantity quantity) {
    output::FramesFile(folder_, {{"hull", output::PartKind::chassis, hull}}, {}).add(frame);
    const output::FramesReader reader(folder_ / "frames.h5");
    PaintOptions options;
    options.ground = quantity, options.labels = false;
    options.view.elevation = 89, options.view.width = 160, options.view.height = 90;
    return FramePainter(reader, options).paint(0);
  };
  EXPECT_THROW(painted(GroundQuantity::Pressure), base::InputError) << "no deformable soil";
  frame.soil = square().soil;
  const auto greenest = [](const Image& image) { // amount of yellow and green soil visible
    int most = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) most = std::max(most, image.at(x, y)[1] - image.at(x, y)[2]);
    return most;
  };
  EXPECT_GT(greenest(painted(GroundQuantity::Pressure)), 80);
  EXPECT_LT(greenest(painted(GroundQuantity::Soil)), 60) << "below an opaque hull";
}

} // namespace
} // namespace grouser::render::ground_colours
