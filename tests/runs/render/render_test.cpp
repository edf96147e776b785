// SPDX-License-Identifier: BSD-3-Clause
#include "runs/render/labels.hpp"
#include "runs/render/picture.hpp"
#include "runs/render/render.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <omp.h>
#include <stdexcept>

namespace grouser::render {
namespace {

constexpr int kWidth = 160, kHeight = 120;

/// Camera at 4 m looking along +y at a sphere of radius 1 at the origin.
Camera front() {
  Camera c;
  c.eye = {0, -4, 0};
  c.target = {0, 0, 0};
  return c;
}

bool isRed(const std::uint8_t* p) { return p[0] > 2 * p[1] && p[0] > 2 * p[2]; }
bool isBlue(const std::uint8_t* p) { return p[2] > 2 * p[0] && p[2] > 2 * p[1]; }

int count(const Image& image, bool (*test)(const std::uint8_t*)) {
  int n = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) n += test(image.at(x, y));
  return n;
}

RenderMesh square(double y, double half, const Colour& colour) {
  return {{{{-half, y, -half}, {half, y, -half}, {half, y, half}, {-half, y, half}}, {0, 1, 2, 0, 2, 3}}, {}, colour};
}

TEST(Render, SphereCoversTheDiscThatPerspectiveGives) {
  const Image image = render({{{{0, 0, 0}, 1, {0.8f, 0, 0}}}, {}}, front(), kWidth, kHeight);
  // Outline: tangent of the half angle, r / sqrt(d^2 - r^2), over that of the half field of view.
  const double half = std::tan(17.5 * M_PI / 180), radius = 0.5 * kHeight * (1 / std::sqrt(15.0)) / half;
  EXPECT_TRUE(isRed(image.at(kWidth / 2, kHeight / 2)));
  EXPECT_TRUE(isRed(image.at(kWidth / 2 + int(radius) - 2, kHeight / 2)));
  EXPECT_FALSE(isRed(image.at(kWidth / 2 + int(radius) + 2, kHeight / 2)));
  EXPECT_FALSE(isRed(image.at(2, 2)));
  // The outline's pixels are mixed with the background: an uncertainty of one pixel all round.
  EXPECT_NEAR(count(image, isRed), M_PI * radius * radius, 2 * M_PI * radius);
}

TEST(Render, SphereIsBrighterOnTopThanBelow) {
  const Image image = render({{{{0, 0, 0}, 1, {0.8f, 0, 0}}}, {}}, front(), kWidth, kHeight);
  EXPECT_GT(image.at(kWidth / 2, kHeight / 2 - 20)[0], image.at(kWidth / 2, kHeight / 2 + 20)[0] + 40);
}

TEST(Render, NearerSurfaceHidesTheFarther) {
  RenderScene scene{{{{0, 0, 0}, 0.3f, {0.8f, 0, 0}}}, {square(-1, 0.5, {0, 0, 0.8f})}};
  Image image = render(scene, front(), kWidth, kHeight);
  EXPECT_TRUE(isBlue(image.at(kWidth / 2, kHeight / 2)));
  EXPECT_EQ(count(image, isRed), 0);
  scene.meshes[0] = square(1, 0.5, {0, 0, 0.8f});
  image = render(scene, front(), kWidth, kHeight);
  EXPECT_TRUE(isRed(image.at(kWidth / 2, kHeight / 2)));
  EXPECT_GT(count(image, isBlue), 0);
}

TEST(Render, OrderOfTheSpheresDoesNotMatter) {
  const RenderSphere near{{0, -1, 0}, 0.5f, {0.8f, 0, 0}}, far{{0, 1, 0}, 0.5f, {0, 0, 0.8f}};
  EXPECT_EQ(render({{near, far}, {}}, front(), kWidth, kHeight).rgb,
            render({{far, near}, {}}, front(), kWidth, kHeight).rgb);
  EXPECT_TRUE(isRed(render({{near, far}, {}}, front(), kWidth, kHeight).at(kWidth / 2, kHeight / 2)));
}

TEST(Render, SquareCoversItsProjection) {
  const Image image = render({{}, {square(0, 0.5, {0, 0, 0.8f})}}, front(), kWidth, kHeight);
  const double edge = kHeight * (1.0 / 4) / (2 * std::tan(17.5 * M_PI / 180));
  EXPECT_NEAR(count(image, isBlue), edge * edge, 4 * edge);
}

TEST(Render, WhatCrossesTheEyeIsClippedNotSmeared) {
  // A long strip from far ahead to behind the camera: it may cover only the lower half of the picture.
  const RenderMesh floor{{{{-1, -9, -1}, {1, -9, -1}, {1, 9, -1}, {-1, 9, -1}}, {0, 1, 2, 0, 2, 3}}, {}, {0, 0, 0.8f}};
  const Image image = render({{}, {floor}}, front(), kWidth, kHeight);
  EXPECT_TRUE(isBlue(image.at(kWidth / 2, kHeight - 1)));
  for (int x = 0; x < kWidth; ++x) EXPECT_FALSE(isBlue(image.at(x, kHeight / 2 - 1)));
}

TEST(Render, ShadowFallsBelowASphere) {
  // A pale floor seen from above; the sphere's shadow points away from the sun, towards +y.
  const RenderMesh floor{
      {{{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}}, {0, 1, 2, 0, 2, 3}}, {}, {0.5f, 0.5f, 0.5f}};
  Camera above;
  above.eye = {0, 0, 9}, above.target = {0, 0, 0}, above.up = {0, 1, 0};
  const Image image = render({{{{0, 0, 1}, 0.5f, {0.8f, 0, 0}}}, {floor}}, above, kWidth, kHeight);
  const double pixels = 0.5 * kHeight / (std::tan(17.5 * M_PI / 180) * 9), shift = 1 / std::tan(50 * M_PI / 180);
  const int lit = image.at(kWidth / 2, kHeight / 2 + int(1.5 * pixels))[1];
  const int dark = image.at(kWidth / 2, kHeight / 2 - int(1.2 * shift * pixels))[1];
  EXPECT_LT(dark, lit - 40);
}

TEST(Render, PictureIsTheSameForEveryNumberOfThreads) {
  RenderScene scene;
  for (int i = 0; i < 200; ++i)
    scene.spheres.push_back({{0.1f * float(i % 20) - 1, 0.1f * float(i / 20) - 0.5f, 0.01f * float(i % 7)},
                             0.06f,
                             heightColour(float(i) / 200)});
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Image first = render(scene, front(), kWidth, kHeight);
  omp_set_num_threads(3);
  const Image second = render(scene, front(), kWidth, kHeight);
  omp_set_num_threads(threads);
  EXPECT_EQ(first.rgb, second.rgb);
}

TEST(Render, ColourMapRunsFromDarkToLight) {
  float last = -1;
  for (int i = 0; i <= 20; ++i) {
    const Colour c = heightColour(float(i) / 20);
    const float luminance = 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
    EXPECT_GT(luminance, last);
    last = luminance;
  }
}

TEST(Picture, LabelsStandOnWidePicturesAlone) {
  output::Frame frame;
  for (int i = 0; i < 100; ++i)
    frame.positions.push_back({0.1f * float(i % 10), 0.1f * float(i / 10), 0.001f * float(i)}),
        frame.radii.push_back(0.05f);
  const int narrow = kNarrowestLabelled - 1, wide = 960;
  EXPECT_EQ(drawFrame(frame, {}, {}, narrow).rgb, drawFrame(frame, {}, {}, narrow, false).rgb);
  const Image plain = drawFrame(frame, {}, {}, wide, false), labelled = drawFrame(frame, {}, {}, wide);
  // Pixels that differ: time in the upper left corner, colours in the upper right one, scale bar at the bottom
  // left.
  int upperLeft = 0, upperRight = 0, lowerLeft = 0, elsewhere = 0;
  for (int y = 0; y < plain.height; ++y)
    for (int x = 0; x < plain.width; ++x) {
      const auto at = 3 * static_cast<std::size_t>(y * plain.width + x);
      if (std::equal(&plain.rgb[at], &plain.rgb[at] + 3, &labelled.rgb[at])) continue;
      const bool left = x<plain.width / 3, right = x> plain.width * 2 / 3;
      if (left && y < plain.height / 5)
        ++upperLeft;
      else if (right && y < plain.height * 3 / 5)
        ++upperRight;
      else if (left && y > plain.height * 4 / 5)
        ++lowerLeft;
      else
        ++elsewhere;
    }
  EXPECT_GT(upperLeft, 500);
  EXPECT_GT(upperRight, 5000);
  EXPECT_GT(lowerLeft, 500);
  EXPECT_EQ(elsewhere, 0);
}

TEST(Labels, ABarOfARoundLengthIsAsLongAsItSays) {
  for (const double perMetre : {7.0, 100.0, 260.0, 3000.0}) {
    Image image;
    image.width = 960, image.height = 540;
    image.rgb.assign(3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height), 128);
    const Font font;
    drawLength(image, font, perMetre);
    // The longest dark row is the bar.
    int longest = 0;
    for (int y = 0; y < image.height; ++y) {
      int dark = 0;
      for (int x = 0; x < image.width; ++x)
        dark += image.rgb[3 * static_cast<std::size_t>(y * image.width + x)] < 60 ? 1 : 0;
      longest = std::max(longest, dark);
    }
    const double metres = longest / perMetre, digits = metres / std::pow(10, std::floor(std::log10(metres) + 1e-2));
    const double nearest = digits < 1.5 ? 1 : digits < 3.5 ? 2 : 5;
    const double pixel = 2 / static_cast<double>(longest); // both ends are whole pixels
    EXPECT_NEAR(digits / nearest, 1, pixel) << perMetre;
    EXPECT_LE(longest, image.width / 6 + 1);
  }
}

TEST(Picture, ShowsGrainsPartsAndGroundAndIsWritten) {
  output::Frame frame;
  for (int i = 0; i < 100; ++i)
    frame.positions.push_back({0.1f * float(i % 10), 0.1f * float(i / 10), 0}), frame.radii.push_back(0.05f);
  const base::TriangleMesh plate = square(0, 0.3, {}).mesh;
  frame.partPoses = {{{0.5, 0.5, 0.4}, {}}};
  const Image image = drawFrame(frame, {{"left shoe 0", output::PartKind::shoe, plate}}, {}, 320);
  EXPECT_EQ(image.height, 180);
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "grouser_picture.png";
  writePng(image, file);
  EXPECT_GT(std::filesystem::file_size(file), 5000u);
  std::filesystem::remove(file);
  EXPECT_THROW(writePng(image, "/nonexistent/picture.png"), std::runtime_error);
}

/// Pixels that differ from an empty picture, and whether any are within two pixels of the edges.
struct Subject {
  int pixels = 0;
  bool isCut = false;
};

Subject subjectOf(const Image& image, const Image& empty) {
  Subject s;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t *a = image.at(x, y), *b = empty.at(x, y);
      if (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]) continue;
      ++s.pixels;
      s.isCut |= x < 2 || y < 2 || x >= image.width - 2 || y >= image.height - 2;
    }
  return s;
}

TEST(Picture, FewGrainsOfAnySizeAreSeenWhole) {
  const Image empty = drawFrame({}, {}, {}, 320);
  for (const float radius : {1e-4f, 0.01f, 2.0f})
    for (const int count : {1, 2, 30}) {
      output::Frame frame;
      for (int i = 0; i < count; ++i)
        frame.positions.push_back({3 * radius * float(i), radius * float(i % 5), 1 + radius * float(i % 3)}),
            frame.radii.push_back(radius);
      const Subject s = subjectOf(drawFrame(frame, {}, {}, 320), empty);
      EXPECT_FALSE(s.isCut) << count << " grains of radius " << radius;
      // A row of 30 is 22 times as long as a grain: it covers only a strip of the picture.
      EXPECT_GT(s.pixels, count < 30 ? 3000 : 500) << count << " grains of radius " << radius;
    }
}

TEST(Picture, StrayGrainDoesNotShrinkABed) {
  const Image empty = drawFrame({}, {}, {}, 320);
  output::Frame frame;
  for (int i = 0; i < 400; ++i)
    frame.positions.push_back({0.1f * float(i % 20), 0.1f * float(i / 20), 0}), frame.radii.push_back(0.05f);
  frame.positions[57] = {1, 1, -500};
  const Subject s = subjectOf(drawFrame(frame, {}, {}, 320), empty);
  EXPECT_FALSE(s.isCut);
  EXPECT_GT(s.pixels, 320 * 180 / 4);
}

base::TriangleMesh level(float half, float z) {
  return {{{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}}, {0, 1, 2, 0, 2, 3}};
}

/// Pixels with the dark colours of deep soil, darker than floor and sky.
int darkPixels(const Image& image) {
  int count = 0;
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
    const auto most = std::max({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
    count += most < 75 ? 1 : 0;
  }
  return count;
}

/// A bed of 40 x 20 grains, and the position of a part above its middle.
output::Frame bedAndBox(float spacing) {
  output::Frame frame;
  for (int i = 0; i < 800; ++i)
    frame.positions.push_back({spacing * float(i % 40), spacing * float(i / 40), 0}),
        frame.radii.push_back(0.5f * spacing);
  frame.partPoses = {{{20 * spacing, 10 * spacing, 0.4}, {}}};
  return frame;
}

TEST(Picture, BedLittleLargerThanTheVehicleIsSeenWhole) {
  const Image empty = drawFrame({}, {}, {}, 320);
  const std::vector<output::FramePart> box{{"chassis", output::PartKind::chassis, level(1.2f, 0)}};
  EXPECT_FALSE(subjectOf(drawFrame(bedAndBox(0.08f), box, {}, 320), empty).isCut) << "3.2 m under 2.4 m";
  EXPECT_TRUE(subjectOf(drawFrame(bedAndBox(0.5f), box, {}, 320), empty).isCut)
      << "20 m: the vehicle fills the picture";
}

TEST(Picture, FloorWithoutAnEndShrinksNoGrains) {
  const Image empty = drawFrame({}, {}, {}, 320);
  output::Frame frame = bedAndBox(0.1f);
  frame.partPoses.clear();
  const int alone = darkPixels(drawFrame(frame, {}, {}, 320));
  const Image onFloor = drawFrame(frame, {}, level(60, -0.05f), 320);
  EXPECT_GT(alone, 1000);
  EXPECT_NEAR(darkPixels(onFloor), alone, 0.1 * alone) << "except for shadows";
  EXPECT_TRUE(subjectOf(onFloor, empty).isCut) << "it continues beyond the picture";
}

} // namespace
} // namespace grouser::render
