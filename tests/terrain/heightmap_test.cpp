// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/heightmap.hpp"

#include "assets/generator_heightmaps/shapes.hpp"
#include "base/error.hpp"
#include "tests/png_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

namespace {

using namespace grouser::terrain;
using grouser::base::InputError;
using namespace grouser::pngs;

class HeightmapFile : public ::testing::Test {
protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    file_ = std::filesystem::temp_directory_path() / (std::string("grouser_") + info->name() + ".png");
  }
  void TearDown() override { std::filesystem::remove(file_); }

  Heightmap load(const Bytes& bytes) {
    std::ofstream(file_, std::ios::binary) << bytes;
    return loadHeightmap(file_);
  }
  /// The error's message, or "no error".
  std::string errorOf(const Bytes& bytes) {
    try {
      load(bytes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  std::filesystem::path file_;
};

TEST_F(HeightmapFile, EightBitGrey_SpansTheFullRangeOfEightBits) {
  const Heightmap map = load(png(3, 2, 8, kGrey, {0, 51, 102, 153, 204, 255}));
  EXPECT_EQ(map.bits, 8);
  ASSERT_EQ(map.columns, 3);
  ASSERT_EQ(map.rows, 2);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(map.at(i % 3, i / 3), i * 51 / 255.0) << i;
}

TEST_F(HeightmapFile, SixteenBitGrey_SpansTheFullRangeOfSixteenBits) {
  const Heightmap map = load(png(2, 2, 16, kGrey, {0, 1, 12345, 65535}));
  EXPECT_EQ(map.bits, 16);
  EXPECT_EQ(map.at(0, 0), 0.0);
  EXPECT_EQ(map.at(1, 0), 1 / 65535.0);
  EXPECT_EQ(map.at(0, 1), 12345 / 65535.0);
  EXPECT_EQ(map.at(1, 1), 1.0);
}

TEST_F(HeightmapFile, RangeIsTheFormats_NotThePictures) {
  const Heightmap map = load(png(2, 2, 8, kGrey, {100, 100, 110, 110}));
  EXPECT_EQ(map.at(0, 0), 100 / 255.0);
  EXPECT_EQ(map.at(0, 1), 110 / 255.0);
}

TEST_F(HeightmapFile, ColourIsKnown_AndGreyInThreeChannelsIsNone) {
  EXPECT_TRUE(load(png(2, 2, 8, kRgb, {9, 9, 9, 9, 8, 9, 9, 9, 9, 9, 9, 9})).colour);
  EXPECT_FALSE(load(png(2, 2, 8, kRgb, {9, 9, 9, 5, 5, 5, 1, 1, 1, 9, 9, 9})).colour);
  EXPECT_FALSE(load(png(2, 2, 8, kGreyAlpha, {9, 1, 9, 2, 9, 3, 9, 4})).colour);
  EXPECT_TRUE(load(png(2, 2, 16, kRgba, std::vector<int>{1, 2, 3, 4, 1, 2, 3, 4, 1, 2, 3, 4, 1, 2, 3, 4})).colour);
}

TEST_F(HeightmapFile, DamagedBytesOfAPng_AreFoundByItsChecksums) {
  const Bytes good = png(3, 3, 8, kGrey, {0, 10, 20, 30, 40, 50, 60, 70, 80});
  ASSERT_EQ(errorOf(good), "no error");
  // Any bit of any chunk after its length: type, data or checksum.
  for (std::size_t at = 12; at < good.size(); ++at) {
    Bytes bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 0x04);
    EXPECT_NE(errorOf(bad), "no error") << at;
  }
  Bytes pixel = good;
  pixel[good.find("IDAT") + 14] ^= 0x20; // a height
  EXPECT_NE(errorOf(pixel).find("damaged or truncated (wrong checksum of chunk IDAT at byte 33)"), std::string::npos)
      << errorOf(pixel);
  EXPECT_NE(errorOf(good.substr(0, good.size() - 12)).find("damaged or truncated"), std::string::npos);
  EXPECT_EQ(errorOf(good + "behind the end mark"), "no error");
}

TEST_F(HeightmapFile, WrongChecksumOfThePixels_IsFoundUnderASoundChunk) {
  const Bytes good = png(2, 2, 8, kGrey, {0, 10, 20, 30});
  const std::size_t type = good.find("IDAT"), end = good.find("IEND") - 8; // start and end of its data
  Bytes stream = good.substr(type + 4, end - type - 4);
  stream.back() = static_cast<char>(stream.back() ^ 1);
  Bytes bad = good.substr(0, type - 4);
  appendChunk(bad, "IDAT", stream);
  appendChunk(bad, "IEND", "");
  EXPECT_NE(errorOf(bad).find("wrong checksum of the pixels"), std::string::npos) << errorOf(bad);
}

TEST_F(HeightmapFile, ColourBeyondThePalette_IsRefused) {
  Bytes two; // colours, black and white; of one byte of alpha
  appendChunk(two, "PLTE", Bytes(3, '\0') + Bytes(3, '\xFF'));
  Bytes transparent = two;
  appendChunk(transparent, "tRNS", "\x7F");
  const Bytes fits{0, 0, 1, 0, 1, 0}, beyond{0, 0, 1, 0, 2, 0};
  const Bytes fitsInFourBits{0, 0x01, 0, 0x10}, beyondInFourBits{0, 0x01, 0, 0x20};
  const Bytes differences{0, 1, 0, 1, 1, 0}, sums{0, 1, 1, 1, 1, 1}; // filter 1 adds the pixel to the left
  const Bytes eight = headerOf(2, 2, 8, kPalette), four = headerOf(2, 2, 4, kPalette);
  for (const Bytes& chunks : {two, transparent}) {
    EXPECT_EQ(load(pngOf(eight, fits, chunks)).brightness, (std::vector<double>{0, 1, 1, 0}));
    EXPECT_EQ(load(pngOf(four, fitsInFourBits, chunks)).brightness, (std::vector<double>{0, 1, 1, 0}));
    EXPECT_EQ(load(pngOf(eight, differences, chunks)).brightness, (std::vector<double>{1, 0, 1, 1}));
    for (const Bytes& bad :
         {pngOf(eight, beyond, chunks), pngOf(four, beyondInFourBits, chunks), pngOf(eight, sums, chunks)})
      EXPECT_NE(errorOf(bad).find("(a pixel has colour 2, the palette ends at 1)"), std::string::npos) << errorOf(bad);
  }
}

TEST_F(HeightmapFile, PixelsThatTheHeaderDoesNotAnnounce_AreRefused) {
  const Bytes threeRows{0, 1, 2, 0, 3, 4, 0, 5, 6};
  EXPECT_EQ(errorOf(pngOf(headerOf(2, 3, 8, kGrey), threeRows)), "no error");
  for (const int rows : {2, 4}) {
    const std::string message = errorOf(pngOf(headerOf(2, rows, 8, kGrey), threeRows));
    EXPECT_NE(message.find(rows == 2 ? "(9 bytes of pixels, the header specifies 6)" : "the header specifies 12"),
              std::string::npos)
        << message;
  }
  // In interlaced pictures three of the seven passes have pixels: (0, 0), (1, 0) and the second row.
  const Bytes header = headerOf(2, 2, 8, kGrey, true), inParts{0, 10, 0, 20, 0, 30, 40};
  EXPECT_EQ(load(pngOf(header, inParts)).at(1, 0), 20 / 255.0);
  EXPECT_NE(errorOf(pngOf(header, inParts + '\x05')).find("the header specifies 7"), std::string::npos);
}

TEST_F(HeightmapFile, DamagedPng_IsRefusedForItsOwnReason) {
  const Bytes good = png(3, 3, 8, kGrey, {0, 10, 20, 30, 40, 50, 60, 70, 80});
  Bytes longer = good, unnamed = good, empty = good.substr(0, 33);
  longer[33] = '\xFF';  // the length of IDAT
  unnamed.erase(8, 25); // IHDR
  appendChunk(empty, "IEND", "");
  const std::vector<std::pair<Bytes, std::string>> cases{
      {longer, "(chunk IDAT at byte 33 specifies 42781"}, // 255 * 2^24 and its own length
      {unnamed, "(its first chunk is not IHDR)"},
      {empty, "(no pixels)"},
      {good.substr(0, good.size() - 5), "(no end mark)"},
      {good.substr(0, good.size() - 12), "(no end mark)"}};
  for (const auto& [bytes, cause] : cases)
    EXPECT_NE(errorOf(bytes).find("damaged or truncated " + cause), std::string::npos) << errorOf(bytes);
}

TEST_F(HeightmapFile, TransparentPixelsAreKnown_AndOpaqueOnesAreNone) {
  EXPECT_TRUE(load(png(2, 2, 8, kGreyAlpha, {9, 255, 9, 254, 9, 255, 9, 255})).transparent);
  EXPECT_FALSE(load(png(2, 2, 8, kGreyAlpha, {9, 255, 9, 255, 9, 255, 9, 255})).transparent);
  EXPECT_FALSE(load(png(2, 2, 8, kRgb, {9, 9, 9, 5, 5, 5, 1, 1, 1, 9, 9, 9})).transparent);
}

TEST_F(HeightmapFile, Colour_BecomesLuminance_AndAlphaIsIgnored) {
  const std::vector<double> pure{0.2126, 0.7152, 0.0722, 1.0};
  const std::vector<int> rgb{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
  const std::vector<int> rgba{255, 0, 0, 0, 0, 255, 0, 77, 0, 0, 255, 255, 255, 255, 255, 1};
  const Heightmap a = load(png(2, 2, 8, kRgb, rgb)), b = load(png(2, 2, 8, kRgba, rgba));
  for (int i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(a.brightness[i], pure[i]) << i;
    EXPECT_EQ(a.brightness[i], b.brightness[i]) << i;
  }
  std::vector<int> deep;
  for (const int v : rgb) deep.push_back(v * 257);
  const Heightmap c = load(png(2, 2, 16, kRgb, deep));
  EXPECT_EQ(c.bits, 16);
  for (int i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(c.brightness[i], pure[i]) << i;
}

TEST_F(HeightmapFile, GreyAsColour_EqualsGreyToTheBit) {
  std::vector<int> grey, rgb, greyAlpha;
  for (int v = 0; v < 256; ++v) {
    grey.push_back(v), greyAlpha.insert(greyAlpha.end(), {v, 255 - v}), rgb.insert(rgb.end(), {v, v, v});
  }
  const auto expected = load(png(16, 16, 8, kGrey, grey)).brightness;
  EXPECT_EQ(load(png(16, 16, 8, kRgb, rgb)).brightness, expected);
  EXPECT_EQ(load(png(16, 16, 8, kGreyAlpha, greyAlpha)).brightness, expected);
}

TEST_F(HeightmapFile, PixelsAreCornerPoints_AndRowZeroIsTheFarEdge) {
  const Heightmap map = load(png(3, 2, 8, kGrey, {0, 255, 0, 255, 0, 255}));
  const HeightField field = heightFieldOf(map, {.sizeX = 20, .sizeY = 8, .black = -0.5, .white = 1.5});
  EXPECT_EQ(field.area().xMin, 0.0);
  EXPECT_EQ(field.area().xMax, 20.0);
  EXPECT_EQ(field.area().yMin, -4.0);
  EXPECT_EQ(field.area().yMax, 4.0);
  EXPECT_EQ(field.height(0, 4), -0.5); // far left: first pixel, black
  EXPECT_EQ(field.height(10, 4), 1.5);
  EXPECT_EQ(field.height(0, -4), 1.5); // near left: first pixel of the second row, white
  EXPECT_EQ(field.height(10, -4), -0.5);
  EXPECT_EQ(field.height(20, -4), 1.5);
}

TEST_F(HeightmapFile, WhiteMayLieBelowBlack) {
  const HeightField field = heightFieldOf(load(png(2, 2, 8, kGrey, {0, 255, 0, 255})),
                                          {.sizeX = 1, .sizeY = 1, .black = 0.25, .white = -0.75});
  EXPECT_EQ(field.height(0, 0), 0.25);
  EXPECT_EQ(field.height(1, 0), -0.75);
}

TEST_F(HeightmapFile, BrokenFiles_GiveOneErrorThatNamesTheFile) {
  const Bytes good = png(8, 8, 16, kGrey, std::vector<int>(64, 4660));
  EXPECT_EQ(errorOf(good), "no error");
  const std::vector<std::pair<Bytes, std::string>> cases{
      {"", "the file is empty"},
      {"version = 1\n[run]\nduration = 2\n", "not a picture"},
      {good.substr(0, 20), "not a picture"},
      {good.substr(0, good.size() / 2), "damaged or truncated"},
      {good.substr(0, 60), "damaged or truncated"},
      {png(1, 1, 8, kGrey, {7}), "1 x 1 pixels; a height-map needs at least 2 x 2"},
      {png(1, 3, 8, kGrey, {7, 8, 9}), "1 x 3 pixels"},
      {png(3, 1, 8, kGrey, {7, 8, 9}), "3 x 1 pixels"},
  };
  for (const auto& [bytes, cause] : cases) {
    const std::string message = errorOf(bytes);
    EXPECT_EQ(message.find(file_.string()), 0u) << message;
    EXPECT_NE(message.find(cause), std::string::npos) << message << " expected: " << cause;
  }
}

TEST_F(HeightmapFile, EveryTruncation_IsAnError) {
  const Bytes good = png(4, 4, 8, kGrey, std::vector<int>(16, 9));
  // All image data are before the last 12 + 4 + 4 bytes (end chunk, checksums).
  for (std::size_t n = 0; n + 20 < good.size(); ++n) EXPECT_NE(errorOf(good.substr(0, n)), "no error") << n << " bytes";
}

TEST_F(HeightmapFile, Jpeg_IsRead_AndCutShortIsAnError) {
  const std::vector<unsigned char> grey(32 * 32, 100);
  Bytes jpeg;
  const auto append = [](void* to, void* data, int size) {
    static_cast<Bytes*>(to)->append(static_cast<char*>(data), size);
  };
  ASSERT_TRUE(stbi_write_jpg_to_func(append, &jpeg, 32, 32, 1, grey.data(), 95));
  EXPECT_NEAR(load(jpeg).at(7, 7), 100 / 255.0, 1 / 255.0); // lossy: a level
  EXPECT_NE(errorOf(jpeg.substr(0, jpeg.size() - 40)).find("truncated"), std::string::npos);
}

TEST_F(HeightmapFile, MissingFileOrFolder_IsAnErrorWithTheRemedy) {
  for (const std::string path : {"/nowhere/hills.png", "/"}) try {
      loadHeightmap(path);
      FAIL() << path;
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find(path), 0u) << message;
      EXPECT_NE(message.find("give the path of a PNG"), std::string::npos) << message;
    }
}

TEST_F(HeightmapFile, PlacementOutOfRange_IsAnError) {
  const Heightmap map = load(png(2, 2, 8, kGrey, {0, 0, 0, 0}));
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const HeightmapPlacement& p : std::vector<HeightmapPlacement>{
           {0, 8, 0, 1}, {20, -8, 0, 1}, {nan, 8, 0, 1}, {20, inf, 0, 1}, {20, 8, nan, 1}, {20, 8, 0, inf}})
    EXPECT_THROW(heightFieldOf(map, p), InputError);
}

TEST(Heightmaps, KeptPictures_AreWhatTheGeneratorDraws) {
  for (const auto& picture : grouser::heightmaps::kPictures) {
    SCOPED_TRACE(picture.name);
    const auto file =
        std::filesystem::path(GROUSER_SOURCE_DIR) / "assets" / "heightmaps" / (std::string(picture.name) + ".png");
    const Heightmap map = loadHeightmap(file);
    ASSERT_EQ(map.columns, picture.columns);
    ASSERT_EQ(map.rows, picture.rows);
    ASSERT_EQ(map.bits, picture.bits);
    const double white = (1 << picture.bits) - 1;
    for (int row = 0; row < map.rows; ++row)
      for (int column = 0; column < map.columns; ++column)
        ASSERT_EQ(map.at(column, row), picture.pixel(column, row) / white) << column << ", " << row;
  }
}

TEST(Heightmaps, ShapesStayInTheRangeOfTheFormat_AtEverySize) {
  for (const auto& picture : grouser::heightmaps::kPictures)
    for (int i = 0; i <= 400; ++i)
      for (int j = 0; j <= 40; ++j) {
        const double b = picture.shape(i / 400.0, j / 40.0);
        ASSERT_TRUE(b >= 0 && b <= 1) << picture.name << " at " << i / 400.0 << ", " << j / 40.0;
      }
}

TEST(Heightmaps, FiguresInTheHelp_AreThoseOfTheShapes) {
  using namespace grouser::heightmaps;
  constexpr double kHigh = 0.4, kLong = 20, kWide = 8; // [m] the terrain in the help
  double low = 1, high = 0, ditchFrom = 1, ditchTo = 0, topFrom = 1, topTo = 0, steepest = 0;
  constexpr int n = 20000;
  for (int i = 0; i <= n; ++i) {
    const double u = double(i) / n;
    low = std::min(low, ditch(u, 0)), high = std::max(high, ditch(u, 0));
    if (ditch(u, 0) < 0.85 - 1e-9) ditchFrom = std::min(ditchFrom, u), ditchTo = std::max(ditchTo, u);
    if (step(u, 0) > 0.8 - 1e-9) topFrom = std::min(topFrom, u), topTo = std::max(topTo, u);
    for (const double v : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const double h = 1e-6, du = (hills(u + h, v) - hills(u - h, v)) / (2 * h) * kHigh / kLong,
                   dv = (hills(u, v + h) - hills(u, v - h)) / (2 * h) * kHigh / kWide;
      steepest = std::max(steepest, std::sqrt(du * du + dv * dv));
    }
  }
  EXPECT_NEAR((high - low) * kHigh, 0.28, 1e-6);
  EXPECT_NEAR((ditchTo - ditchFrom) * kLong, 3.2, 2 * kLong / n + 1e-3); // the cosine is flat near its top
  EXPECT_NEAR((step(0.5, 0) - step(0, 0)) * kHigh, 0.24, 1e-12);
  EXPECT_EQ(step(0.95, 0), step(0, 0));
  EXPECT_NEAR((topTo - topFrom) * kLong, 4.8, 2 * kLong / n);
  EXPECT_NEAR((sideSlope(1, 1) - sideSlope(1, 0)) * kHigh / kWide, 0.05, 1e-12);
  EXPECT_GT(steepest, 0.10);
  EXPECT_LT(steepest, 0.145);
}

TEST(Heightmaps, HillsInEightBits_AreTheSameHillsToHalfALevel) {
  const std::filesystem::path folder = std::filesystem::path(GROUSER_SOURCE_DIR) / "assets" / "heightmaps";
  const Heightmap deep = loadHeightmap(folder / "hills.png"), coarse = loadHeightmap(folder / "hills8.png");
  ASSERT_EQ(deep.brightness.size(), coarse.brightness.size());
  // Rounding to the nearest level: half a level of 8 bits and half a level of 16 bits.
  for (std::size_t i = 0; i < deep.brightness.size(); ++i)
    ASSERT_NEAR(deep.brightness[i], coarse.brightness[i], 0.5 / 255 + 0.5 / 65535);
}

} // namespace
