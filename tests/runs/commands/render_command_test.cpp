// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "runs/commands/render_command.hpp"
#include "runs/output/frames_file.hpp"
#include "runs/render/film.hpp"
#include "runs/render/frame_painter.hpp"
#include "runs/render/labels.hpp"
#include "runs/support/not_written.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

std::string messageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const base::InputError& e) {
    return e.what();
  }
  return "nothing was thrown";
}

/// Six frames, 0.1 s apart, of a row of grains along x and a cube moving 1 m per frame.
class RenderFrames : public FolderTest {
protected:
  static constexpr std::size_t kFrames = 6;

  void SetUp() override {
    FolderTest::SetUp();
    base::TriangleMesh cube;
    for (const double x : {-0.5, 0.5})
      for (const double y : {-0.5, 0.5})
        for (const double z : {-0.5, 0.5}) cube.vertices.push_back({x, y, z});
    cube.indices = {0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                    2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
    output::FramesFile file(folder_, {{"hull", output::PartKind::chassis, cube}}, {});
    for (std::size_t k = 0; k < kFrames; ++k) file.add(frame(k));
  }

  static output::Frame frame(std::size_t k) {
    output::Frame f;
    f.step = static_cast<std::int64_t>(k), f.time = 0.1 * static_cast<double>(k);
    for (int i = 0; i < 20; ++i) {
      f.positions.push_back({0.3f * float(i), 0, -1.0f - 0.01f * float(k)});
      f.radii.push_back(0.15f), f.velocities.push_back({0.1f * float(k), 0, 0}),
          f.ids.push_back(static_cast<std::uint32_t>(i));
    }
    f.partPoses.push_back({{static_cast<double>(k), 0, 0}, {}});
    if (k > 0) f.borders[0] = {1.5};
    return f;
  }

  RenderCommand command() const {
    RenderCommand c;
    c.frames = (folder_ / "frames.h5").string(), c.folder = (folder_ / "out").string();
    c.size = "96x54", c.threads = 1;
    return c;
  }

  std::vector<std::string> written() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "out"))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
};

TEST_F(RenderFrames, ReaderGivesBackWhatTheFileWasGiven) {
  const output::FramesReader reader(folder_ / "frames.h5");
  ASSERT_EQ(reader.count(), kFrames);
  EXPECT_EQ(reader.time(3), frame(3).time);
  const output::StoredFrame f = reader.read(3);
  EXPECT_EQ(f.positions, frame(3).positions);
  for (std::size_t i = 0; i < f.speeds.size(); ++i) EXPECT_EQ(f.speeds[i], frame(3).velocities[i].x);
  EXPECT_EQ(f.borders[0], frame(3).borders[0]);
  EXPECT_TRUE(reader.read(0).borders[0].empty());
  ASSERT_EQ(reader.parts().size(), 1u);
  EXPECT_EQ(reader.parts()[0].kind, output::PartKind::chassis);
  EXPECT_EQ(f.partVertices[7], (base::Vec3f{3.5f, 0.5f, 0.5f}));
}

TEST_F(RenderFrames, DamagedFileIsNamedNotDrawn) {
  const fs::path path = folder_ / "frames.h5";
  {
    support::Hdf5File file = support::Hdf5File::openToChange(path);
    file.remove("/000002/grains/radius");
    file.write("/000002/grains/radius", std::vector<float>(19, 0.1f), {19});
    file.remove("/000004/parts/position");
    file.write("/000004/parts/position", std::vector<float>(21, 0.0f), {7, 3});
    file.remove("/000005/grains/position");
    file.write("/000005/grains/position", std::vector<float>(60, NAN), {20, 3});
  }
  const auto faultOf = [&](std::size_t frame) { return messageOf([&] { output::FramesReader(path).read(frame); }); };
  EXPECT_NE(faultOf(2).find("/000002/grains/radius"), std::string::npos);
  EXPECT_NE(faultOf(4).find("hull"), std::string::npos);
  EXPECT_NE(faultOf(5).find("is not finite"), std::string::npos);
  const auto rewrite = [&](const std::string& dataset, const auto& numbers, const std::vector<std::uint64_t>& shape) {
    support::Hdf5File file = support::Hdf5File::openToChange(path);
    file.remove(dataset);
    file.write(dataset, numbers, shape);
  };
  for (const float radius : {1e30f, 0.0f}) {
    std::vector<float> radii(20, 0.1f);
    radii[0] = radius;
    rewrite("/000003/grains/radius", radii, {20});
    EXPECT_NE(faultOf(3).find("/000003/grains/radius has a radius outside"), std::string::npos);
  }
  rewrite("/parts/triangles", std::vector<std::uint32_t>{4294967295u, 1, 2}, {1, 3});
  EXPECT_NE(messageOf([&] { output::FramesReader again(path); }).find("the vertex index 4294967295"),
            std::string::npos);
  const fs::path other = folder_ / "other.h5";
  std::ofstream(other, std::ios::binary) << "no HDF5";
  EXPECT_NE(messageOf([&] { output::FramesReader again(other); }).find("is not an HDF5 file"), std::string::npos);
  EXPECT_NE(messageOf([&] { output::FramesReader none(folder_ / "none.h5"); }).find("no such file"), std::string::npos);
}

TEST_F(RenderFrames, PicturesAreTheSameByOneProcessAndByThree) {
  RenderCommand c = command();
  renderCommand(c);
  const std::vector<std::string> names = written();
  ASSERT_EQ(names.size(), kFrames);
  std::vector<std::string> pictures;
  for (const std::string& name : names) pictures.push_back(contents(folder_ / "out" / name));
  EXPECT_NE(pictures[1], pictures[4]);
  c.processes = 3, c.force = true;
  fs::remove_all(c.folder);
  renderCommand(c);
  EXPECT_EQ(written(), names);
  for (std::size_t i = 0; i < names.size(); ++i)
    EXPECT_EQ(contents(folder_ / "out" / names[i]), pictures[i]) << names[i];
}

TEST_F(RenderFrames, FramesAreChosenByTimeCountAndNumber) {
  RenderCommand c = command();
  c.from = 0.1, c.to = 0.5, c.every = 2;
  renderCommand(c);
  EXPECT_EQ(written(), (std::vector<std::string>{"frame_000001.png", "frame_000003.png", "frame_000005.png"}));
  fs::remove_all(c.folder);
  c = command();
  c.frame = {4, 0, 4};
  renderCommand(c);
  EXPECT_EQ(written(), (std::vector<std::string>{"frame_000000.png", "frame_000004.png"}));
}

TEST_F(RenderFrames, WhatIsThereIsOverwrittenOnlyByForce) {
  RenderCommand c = command();
  c.frame = {2};
  renderCommand(c);
  std::ofstream(folder_ / "out" / "frame_000002.png") << "mine";
  EXPECT_NE(messageOf([&] { renderCommand(c); }).find("--force"), std::string::npos);
  EXPECT_EQ(contents(folder_ / "out" / "frame_000002.png"), "mine");
  c.force = true;
  renderCommand(c);
  EXPECT_NE(contents(folder_ / "out" / "frame_000002.png"), "mine");
}

TEST_F(RenderFrames, WrongWordsAreNamedAndNothingIsWritten) {
  const auto message = [&](void (*change)(RenderCommand&)) {
    RenderCommand c = command();
    change(c);
    return messageOf([&] { renderCommand(c); });
  };
  const auto says = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_PRED2(says, message([](RenderCommand& c) { c.color = "sped"; }), "did you mean speed");
  EXPECT_PRED2(says, message([](RenderCommand& c) { c.color = "presure"; }), "did you mean pressure");
  EXPECT_PRED2(says, message([](RenderCommand& c) { c.color = "pressure"; }), "no deformable soil");
  EXPECT_PRED2(says, message([](RenderCommand& c) { c.size = "100"; }), "WIDTHxHEIGHT");
  EXPECT_PRED2(says, message([](RenderCommand& c) { c.size = "100x9999999"; }), "WIDTHxHEIGHT");
  EXPECT_PRED2(says, message([](RenderCommand& c) { c.range = {2, 1}; }), "lower end first");
  EXPECT_PRED2(says, message([](RenderCommand& c) { c.frame = {6}; }), "frames 0 to 5");
  EXPECT_PRED2(says, message([](RenderCommand& c) { c.from = 7; }), "no frames between");
  EXPECT_PRED2(says, message([](RenderCommand& c) { c.borders = {"x=a"}; }), "is not a number");
  EXPECT_PRED2(says, message([](RenderCommand& c) { c.lookAt = "1,2"; }), "a point X,Y,Z");
  EXPECT_PRED2(says, message([](RenderCommand& c) { c.film = "film.gif"; }), ".mp4");
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(RenderFrames, CameraMovesWithTheVehicle) {
  const output::FramesReader reader(folder_ / "frames.h5");
  render::PaintOptions o;
  o.view.width = 96, o.view.height = 54, o.labels = false;
  // The cube of each frame: grains far below are excluded.
  const auto cubeColumns = [&](render::LookAt lookAt, std::size_t frame) {
    o.view.lookAt = lookAt, o.view.azimuth = -90, o.view.elevation = 0;
    const render::Image image = render::FramePainter(reader, o).paint(frame);
    double sum = 0, count = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::uint8_t* p = image.at(x, y);
        if (p[1] > p[2] + 10 && p[1] > p[0]) sum += x, count += 1; // the hull's green
      }
    return count > 0 ? sum / count : -1;
  };
  EXPECT_NEAR(cubeColumns(render::LookAt::Vehicle, 0), 47.5, 1); // a pixel
  EXPECT_NEAR(cubeColumns(render::LookAt::Vehicle, 5), 47.5, 1);
  EXPECT_GT(cubeColumns(render::LookAt::All, 5), cubeColumns(render::LookAt::All, 0) + 30);
}

TEST_F(RenderFrames, FilmHoldsAllPicturesOrIsNotThere) {
  RenderCommand c = command();
  c.film = (folder_ / "film.mp4").string(), c.size = "97x55"; // odd sizes are padded
  if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) {
    EXPECT_NE(messageOf([&] { renderCommand(c); }).find("install the package ffmpeg"), std::string::npos);
    EXPECT_FALSE(fs::exists(c.folder));
    return;
  }
  renderCommand(c);
  EXPECT_EQ(contents(c.film).substr(4, 4), "ftyp"); // header of MP4 files
  EXPECT_FALSE(fs::exists(folder_ / ".film.part.mp4"));
  EXPECT_FALSE(fs::exists(folder_ / ".film.log"));
  std::ofstream(folder_ / "bad.png") << "no picture";
  EXPECT_THROW(render::makeFilm({folder_ / "bad.png"}, 25, folder_ / "bad.mp4"), std::runtime_error);
  EXPECT_FALSE(fs::exists(folder_ / "bad.mp4"));
}

TEST(GrainColours, GrainSpansWhereItsSurfaceCrossesABorder) {
  const render::Borders borders = render::bordersOf({"x=0.5", "z=-1,2"});
  EXPECT_EQ(borders[2], (std::vector<double>{-1, 2}));
  EXPECT_TRUE(render::spans(borders, {0.45f, 0, 0}, 0.1f));
  EXPECT_FALSE(render::spans(borders, {0.25f, 0, 0}, 0.25f)); // touches it
  EXPECT_TRUE(render::spans(borders, {0, 0, -0.9f}, 0.2f));
  EXPECT_EQ(render::subdomainAt(borders, {0.5f, 0, 3}), (std::array<int, 3>{1, 0, 2}));
  EXPECT_EQ(render::subdomainAt(borders, {0.4f, 9, 0}), (std::array<int, 3>{0, 0, 1}));
}

TEST(GrainColours, RolesHaveThePapersColours) {
  output::StoredFrame f;
  f.positions = {{0, 0, 0}, {1, 0, 0}, {0.5f, 0, 0}}, f.radii = {0.1f, 0.1f, 0.1f}, f.speeds = {0, 0, 0};
  const render::GrainColours colours(render::GrainQuantity::Role, f, {f}, {});
  const std::vector<render::Colour> c = colours.of(f, render::bordersOf({"x=0.5"}));
  EXPECT_GT(render::toSrgb(c[0])[1], 230);                          // white
  EXPECT_LT(render::toSrgb(c[1])[0], 90);                           // dark grey
  EXPECT_NEAR(render::toSrgb(c[1])[0], render::toSrgb(c[1])[2], 8); // grey, not coloured
  EXPECT_GT(render::toSrgb(c[2])[0], 5 * render::toSrgb(c[2])[1]);  // red
  EXPECT_EQ(colours.legend(render::bordersOf({"x=0.5"})).size(), 3u);
}

TEST(GrainColours, DepthIsMeasuredFromTheFirstFramesSurface) {
  // A sloping bed of three layers; one grain of the top layer is pushed down by 0.05 m.
  output::StoredFrame first;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y)
      for (int layer = 0; layer < 3; ++layer) {
        first.positions.push_back({0.02f * float(x), 0.02f * float(y), 0.01f * float(x) - 0.02f * float(layer)});
        first.radii.push_back(0.01f), first.speeds.push_back(0);
      }
  output::StoredFrame later = first;
  later.positions[0].z -= 0.05f;
  const render::GrainColours colours(render::GrainQuantity::Depth, first, {first}, render::ValueRange{0, 0.12});
  const auto light = [](const render::Colour& c) { return c.x + c.y + c.z; };
  const std::vector<render::Colour> before = colours.of(first, {}), after = colours.of(later, {});
  EXPECT_LT(light(before[1]), light(before[0])); // deeper is darker
  EXPECT_LT(light(before[2]), light(before[1]));
  EXPECT_LT(light(after[0]), light(before[2]));
  const render::BedTop top(first);
  EXPECT_NEAR(top.height(0.01, 0.01), 0.02, 0.011); // cells of 0.04 m on a slope of one half
  EXPECT_NEAR(top.height(99, 99), 0.2, 0.011);      // beyond the edge: as at the edge
}

TEST(Labels, TicksAreRoundAndWithinTheRange) {
  EXPECT_EQ(render::ticks(0, 1, 5), (std::vector<double>{0, 0.2, 0.4, 0.6000000000000001, 0.8, 1}));
  for (const auto& [low, high] : {std::pair{-0.013, 0.14}, {0.0, 3.7e-5}, {-2e4, 7e6}}) {
    const std::vector<double> t = render::ticks(low, high, 5);
    EXPECT_GE(t.size(), 3u);
    EXPECT_LE(t.size(), 7u);
    EXPECT_GE(t.front(), low - 1e-9 * (high - low));
    EXPECT_LE(t.back(), high + 1e-9 * (high - low));
  }
}

TEST(Labels, CaptionIsDarkOnLightAndStaysInItsCorner) {
  render::Image image{1280, 720, std::vector<std::uint8_t>(1280 * 720 * 3, 100)};
  render::drawCaption(image, render::Font(), "t = 1.250 s");
  int dark = 0, light = 0, elsewhere = 0;
  for (int y = 0; y < 720; ++y)
    for (int x = 0; x < 1280; ++x) {
      const int v = image.at(x, y)[0];
      if (x < 320 && y < 90)
        dark += v<60, light += v> 180;
      else
        elsewhere += v != 100;
    }
  EXPECT_GT(dark, 30);
  EXPECT_GT(light, 200);
  EXPECT_EQ(elsewhere, 0);
}

} // namespace
} // namespace grouser::commands
