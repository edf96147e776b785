// SPDX-License-Identifier: BSD-3-Clause
// A frame with all different numbers, read back: grains, parts at their poses, borders.
#include "runs/output/frames_reader.hpp"
#include "runs/output/output.hpp"
#include "runs/output/sinkage.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/support/hdf5_file.hpp"
#include "tests/runs/csv_fixture.hpp"
#include "tests/runs/folder_fixture.hpp"
#include "tests/runs/scene_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::output {

using namespace test; // fixtures

namespace {

class FramesValues : public FolderTest {
protected:
  void SetUp() override {
    FolderTest::SetUp();
    std::filesystem::remove(folder_);
  }
  static setup::Provenance provenance() {
    return setup::provenanceOf(setup::parseScene(goodScene(), std::string(GROUSER_SOURCE_DIR) + "/scene.toml"));
  }
  static Frame numbered() {
    Frame f;
    f.step = 40, f.time = 0.625;
    float next = 1;
    const auto vec = [&next] {
      const base::Vec3f v{next, next + 0.25f, -next - 0.5f};
      next += 1;
      return v;
    };
    for (std::uint32_t i = 0; i < 3; ++i) {
      f.positions.push_back(vec()), f.velocities.push_back(vec()), f.contactForces.push_back(vec());
      f.radii.push_back(0.125f * static_cast<float>(i + 1)), f.ids.push_back(7 * i + 5);
    }
    f.withContactForces = true;
    f.borders = {std::vector<double>{1.5}, std::vector<double>{2.5, 3.5}, std::vector<double>{4.5, 5.5, 6.5}};
    // A quarter turn about z takes (1, 0, 0) to (0, 1, 0).
    f.partPoses = {{{10, 20, 30}, {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}, {{-1, -2, -3}, {}}};
    return f;
  }
  static base::TriangleMesh triangle() { return {{{0, 0, 0}, {1, 0, 0}, {0, 2, 5}}, {0, 1, 2}}; }
};

TEST_F(FramesValues, EachQuantityOfEachGrainIsReadBack) {
  {
    RunWriter writer(folder_, provenance(), {}, {});
    writer.setParts({{"hull", PartKind::chassis, triangle()}, {"left shoe 0", PartKind::shoe, triangle()}}, {});
    writer.frame(numbered());
    writer.finish({});
  }
  const support::Hdf5File file = support::Hdf5File::open(folder_ / "frames.h5");
  const Frame f = numbered();
  EXPECT_EQ(file.number("/000000", "step"), 40);
  EXPECT_EQ(file.number("/000000", "time"), 0.625);
  const std::string at = "/000000/grains/";
  const auto vectors = [&](const char* name, const std::vector<base::Vec3f>& wanted) {
    const std::vector<double> is = file.numbers(at + name);
    ASSERT_EQ(is.size(), 9u);
    for (std::size_t i = 0; i < 9; ++i)
      EXPECT_EQ(is[i], static_cast<double>(wanted[i / 3][static_cast<int>(i % 3)])) << name << i;
  };
  vectors("position", f.positions), vectors("velocity", f.velocities), vectors("contact_force", f.contactForces);
  EXPECT_EQ(file.numbers(at + "radius"), (std::vector<double>{0.125, 0.25, 0.375}));
  EXPECT_EQ(file.numbers(at + "id"), (std::vector<double>{5, 12, 19}));
  const std::vector<double> speed = file.numbers(at + "speed");
  for (std::size_t i = 0; i < 3; ++i) {
    const base::Vec3f& v = f.velocities[i];
    EXPECT_NEAR(speed[i], std::sqrt(static_cast<double>(v.x * v.x + v.y * v.y + v.z * v.z)), 1e-6);
  }
  EXPECT_EQ(file.numbers("/000000/partition/x"), (std::vector<double>{1.5}));
  EXPECT_EQ(file.numbers("/000000/partition/y"), (std::vector<double>{2.5, 3.5}));
  EXPECT_EQ(file.numbers("/000000/partition/z"), (std::vector<double>{4.5, 5.5, 6.5}));
}

TEST_F(FramesValues, PartsStandAtTheirPoses) {
  {
    RunWriter writer(folder_, provenance(), {}, {});
    writer.setParts({{"hull", PartKind::chassis, triangle()}, {"left shoe 0", PartKind::shoe, triangle()}}, {});
    writer.frame(numbered());
    writer.finish({});
  }
  const support::Hdf5File file = support::Hdf5File::open(folder_ / "frames.h5");
  const std::vector<double> is = file.numbers("/000000/parts/position"),
                            wanted = {10, 20, 30, 10, 21, 30, 8, 20, 35, -1, -2, -3, 0, -2, -3, -1, 0, 2};
  ASSERT_EQ(is.size(), wanted.size());
  for (std::size_t i = 0; i < is.size(); ++i) EXPECT_NEAR(is[i], wanted[i], 4e-6) << i; // floats
  EXPECT_EQ(file.numbers("/parts/part"), (std::vector<double>{0, 1}));
  EXPECT_EQ(file.numbers("/parts/kind"), (std::vector<double>{0, 1}));
  EXPECT_EQ(file.texts("/parts/part", "names"), (std::vector<std::string>{"hull", "left shoe 0"}));
}

TEST_F(FramesValues, SinkageCsvHasEachShoeOfEachTrackInItsOwnColumn) {
  const std::vector<Channel> channels = {{"vehicle/left/sinkage", "m", "", 2, {}},
                                         {"vehicle/right/sinkage", "m", "", 2, {}}};
  {
    RunWriter writer(folder_, provenance(), channels, {});
    for (int r = 0; r < 3; ++r) writer.row({10 * r, 0.5 * r, {1.0 + 10 * r, 2.0 + 10 * r, 3.0 + 10 * r, 4.0 + 10 * r}});
    writer.finish({});
  }
  const Csv csv(writeSinkageCsv(folder_ / "results.h5", folder_));
  for (std::size_t r = 0; r < 3; ++r) {
    const double ten = 10 * static_cast<double>(r);
    EXPECT_EQ(csv.number(r, "time [s]"), 0.5 * static_cast<double>(r));
    EXPECT_EQ(csv.number(r, "left 0 [m]"), 1 + ten);
    EXPECT_EQ(csv.number(r, "left 1 [m]"), 2 + ten);
    EXPECT_EQ(csv.number(r, "right 0 [m]"), 3 + ten);
    EXPECT_EQ(csv.number(r, "right 1 [m]"), 4 + ten);
  }
}

} // namespace
} // namespace grouser::output
