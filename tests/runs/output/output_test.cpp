// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/output.hpp"
#include "runs/setup/load_scene.hpp"

#include "base/error.hpp"
#include "runs/output/sinkage.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/support/hdf5_file.hpp"
#include "tests/runs/folder_fixture.hpp"
#include "tests/runs/row_builder.hpp"
#include "tests/runs/scene_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

namespace grouser::output {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) all.push_back(line);
  return all;
}

std::vector<double> cells(const std::string& line) {
  std::vector<double> all;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) all.push_back(std::stod(cell));
  return all;
}

/// A run into a new folder.
class Output : public FolderTest {
protected:
  void SetUp() override {
    FolderTest::SetUp();
    fs::remove(folder_);
  }

  scene::Scene scene() const { return setup::parseScene(goodScene(), std::string(GROUSER_SOURCE_DIR) + "/scene.toml"); }

  static std::vector<Channel> channels() {
    return {{"vehicle/left/sinkage", "m", "of each shoe", 3, {}},
            {"vehicle/right/sinkage", "m", "of each shoe", 3, {}},
            {"vehicle/position", "m", "of the hull", 3, {"x", "y", "z"}},
            {"ledger/residual", "J", "residual", 1, {}}};
  }

  /// Ten rows with numbers that identify their position.
  static Row numbered(int r) {
    RowBuilder row(channels());
    row.begin(100 * r, 0.1 * r);
    row.set("vehicle/left/sinkage", std::vector<double>{r + 0.1, r + 0.2, std::nan("")});
    row.set("vehicle/position", base::Vec3d{1.0 * r, 2.0 * r, 3.0 * r});
    row.set("ledger/residual", -r / 3.0);
    return row.row();
  }

  static base::TriangleMesh triangle() { return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}}; }

  static Frame frame(int f, int grains) {
    Frame out;
    out.step = 10 * f, out.time = 0.25 * f;
    for (int i = 0; i < grains; ++i) {
      out.positions.push_back({0.1f * static_cast<float>(i), 0, static_cast<float>(f)});
      out.radii.push_back(0.05f), out.velocities.push_back({0, 0.6f, -0.8f}),
          out.ids.push_back(static_cast<std::uint32_t>(i));
    }
    out.partPoses = {{{0, 0, 1.0 * f}, {}}, {{5, 0, 0}, {}}};
    out.withContactForces = true;
    for (int i = 0; i < grains; ++i) out.contactForces.push_back({0, static_cast<float>(i), static_cast<float>(f)});
    return out;
  }
};

TEST_F(Output, RowsReadBackFromHdf5ToTheSameBits) {
  {
    RunWriter writer(folder_, setup::provenanceOf(scene()), channels(), {});
    writer.constant(output::kPitchRadius, 0.245);
    for (int r = 0; r < 100; ++r) writer.row(numbered(r));
    writer.finish({});
  }
  const support::Hdf5File file = support::Hdf5File::open(folder_ / "results.h5");
  EXPECT_EQ(file.shape("/vehicle/left/sinkage/value"), (std::vector<std::uint64_t>{100, 3}));
  EXPECT_EQ(file.shape("/ledger/residual/value"), std::vector<std::uint64_t>{100});
  EXPECT_EQ(file.text("/vehicle/left/sinkage/value", "unit"), "m");
  EXPECT_EQ(file.texts("/vehicle/position/value", "labels"), (std::vector<std::string>{"x", "y", "z"}));
  EXPECT_EQ(file.numbers("/vehicle/pitch_radius"), std::vector<double>{0.245});
  const std::vector<double> sinkage = file.numbers("/vehicle/left/sinkage/value"),
                            residual = file.numbers("/ledger/residual/value");
  const std::vector<double> time = file.numbers("/ledger/residual/time"), step = file.numbers("/ledger/residual/step");
  for (int r = 0; r < 100; ++r) {
    const auto i = static_cast<std::size_t>(r);
    EXPECT_EQ(sinkage[3 * i + 1], r + 0.2);
    EXPECT_TRUE(std::isnan(sinkage[3 * i + 2]));
    EXPECT_EQ(residual[i], -r / 3.0);
    EXPECT_EQ(time[i], 0.1 * r);
    EXPECT_EQ(step[i], 100.0 * r);
  }
  // Unset values of a row are NaN, never stale numbers.
  EXPECT_TRUE(std::isnan(file.numbers("/vehicle/right/sinkage/value")[0]));
}

TEST_F(Output, FramesHoldVelocitiesAndContactForcesAsVectors) {
  {
    RunWriter writer(folder_, setup::provenanceOf(scene()), channels(), {});
    writer.setParts({{"hull", PartKind::chassis, triangle()}, {"shoe", PartKind::shoe, triangle()}}, {});
    for (int f = 0; f < 2; ++f) writer.frame(frame(f, 3));
    Frame without = frame(2, 3);
    without.withContactForces = false, without.contactForces.clear();
    writer.frame(without);
    writer.finish({});
  }
  const support::Hdf5File file = support::Hdf5File::open(folder_ / "frames.h5");
  EXPECT_EQ(file.shape("/000001/grains/velocity"), (std::vector<std::uint64_t>{3, 3}));
  const std::vector<double> velocity = file.numbers("/000001/grains/velocity"),
                            force = file.numbers("/000001/grains/contact_force"),
                            speed = file.numbers("/000001/grains/speed");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(static_cast<float>(velocity[3 * i + 1]), 0.6f);
    EXPECT_EQ(static_cast<float>(velocity[3 * i + 2]), -0.8f);
    EXPECT_NEAR(speed[i], 1, 1e-7); // rounding to float
    EXPECT_EQ(force[3 * i + 1], static_cast<double>(i));
    EXPECT_EQ(force[3 * i + 2], 1);
  }
  EXPECT_FALSE(file.has("/000002/grains/contact_force"));
  std::ifstream text(folder_ / "frames.xdmf");
  const std::string xdmf{std::istreambuf_iterator<char>(text), {}};
  const auto count = [&](const std::string& word) {
    std::size_t n = 0;
    for (std::size_t at = xdmf.find(word); at != std::string::npos; at = xdmf.find(word, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("Attribute Name=\"velocity\" AttributeType=\"Vector\""), 3u);
  EXPECT_EQ(count("frames.h5:/000001/grains/contact_force"), 1u);
  EXPECT_EQ(count("/grains/contact_force"), 2u);
}

TEST_F(Output, ResultsHoldSceneCommitAndMachine) {
  RunWriter(folder_, setup::provenanceOf(scene()), channels(), {}).finish({});
  const support::Hdf5File file = support::Hdf5File::open(folder_ / "results.h5");
  EXPECT_EQ(file.text("/", "scene"), scene::resolvedToml(scene()));
  EXPECT_NE(file.text("/", "commit"), "");
  EXPECT_NE(file.text("/", "machine"), "");
  EXPECT_EQ(scene::resolvedToml(setup::loadScene(folder_ / "scene.toml")), scene::resolvedToml(scene()));
}

TEST_F(Output, CsvHasTheNarrowChannelsToTheSameBits) {
  RunWriter writer(folder_, setup::provenanceOf(scene()), channels(), {});
  for (int r = 0; r < 3; ++r) writer.row(numbered(r));
  const std::vector<std::string> text = lines(contents(folder_ / "timeseries.csv"));
  ASSERT_EQ(text.size(), 4u);
  EXPECT_EQ(text[0],
            "step,time [s],vehicle.position.x [m],vehicle.position.y [m],vehicle.position.z [m],ledger.residual [J]");
  EXPECT_EQ(cells(text[3]), (std::vector<double>{200, 0.1 * 2, 2, 4, 6, -2 / 3.0}));
}

TEST_F(Output, UnfinishedRunLeavesReadableRows) {
  RunWriter writer(folder_, setup::provenanceOf(scene()), channels(), {});
  for (int r = 0; r < 5; ++r) writer.row(numbered(r));
  // A copy of the files on disk now is the result of a killed program.
  fs::copy_file(folder_ / "results.h5", folder_ / "killed.h5");
  const support::Hdf5File file = support::Hdf5File::open(folder_ / "killed.h5");
  EXPECT_EQ(file.numbers("/ledger/residual/value").size(), 5u);
  EXPECT_EQ(file.numbers("/ledger/residual/value")[4], -4 / 3.0);
  EXPECT_NE(contents(folder_ / "manifest.json").find("\"status\": \"running\""), std::string::npos);
}

TEST_F(Output, ManifestSaysWhatWasRunAndHowItEnded) {
  RunWriter::Options options;
  options.metadata = {{"device", "cpu"}};
  scene::Scene s = scene();
  s.overrides = {"run.seed=3"};
  RunWriter writer(folder_, setup::provenanceOf(s), channels(), options);
  Summary summary;
  summary.steps = 42, summary.stateHash = "00ff", summary.figures["grain_steps_per_second"] = 1e6;
  writer.finish(summary);
  const std::string text = contents(folder_ / "manifest.json");
  for (const char* part : {"\"status\": \"finished\"", "\"run.seed=3\"", "\"device\": \"cpu\"", "\"steps\": 42",
                           "\"state_hash\": \"00ff\"", "\"results.h5\"", "\"commit\"", "\"machine\"", "\"wall_time_s\"",
                           "grain_steps_per_second"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST_F(Output, FilledFolderIsLeftAloneWithoutForce) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "results.h5") << "precious";
  std::ofstream(folder_ / "notes.txt") << "mine";
  try {
    const RunWriter refused(folder_, setup::provenanceOf(scene()), channels(), {});
    FAIL();
  } catch (const base::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("--force"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("--out"), std::string::npos);
  }
  EXPECT_EQ(contents(folder_ / "results.h5"), "precious");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}), 2);

  RunWriter::Options force;
  force.force = true;
  RunWriter(folder_, setup::provenanceOf(scene()), channels(), force).finish({});
  EXPECT_NO_THROW(support::Hdf5File::open(folder_ / "results.h5"));
  EXPECT_EQ(contents(folder_ / "notes.txt"), "mine");
}

TEST_F(Output, FileWhereTheFolderShouldBeIsAnInputError) {
  std::ofstream(folder_) << "a file";
  EXPECT_THROW(checkOutputFolder(folder_, true), base::InputError);
}

TEST_F(Output, WrongRowLengthIsACallersFault) {
  RunWriter writer(folder_, setup::provenanceOf(scene()), channels(), {});
  EXPECT_THROW(writer.row({0, 0, {1, 2}}), std::logic_error);
  RowBuilder row(channels());
  EXPECT_THROW(row.set("vehicle/positon", 1.0), std::logic_error);
  EXPECT_THROW(row.set("vehicle/position", 1.0), std::logic_error);
}

TEST_F(Output, EveryXdmfReferenceExistsWithItsDimensions) {
  RunWriter writer(folder_, setup::provenanceOf(scene()), channels(), {});
  writer.setParts({{"left shoe 0", PartKind::shoe, triangle()}, {"chassis", PartKind::chassis, triangle()}},
                  triangle());
  for (int f = 0; f < 3; ++f) writer.frame(frame(f, 4 + f));
  writer.finish({});
  const std::string xml = contents(folder_ / "frames.xdmf");
  const support::Hdf5File file = support::Hdf5File::open(folder_ / "frames.h5");
  const auto between = [&xml](const std::string& open, const std::string& close, std::size_t from) {
    const std::size_t begin = xml.find(open, from) + open.size();
    return xml.substr(begin, xml.find(close, begin) - begin);
  };
  int references = 0;
  for (std::size_t at = 0; (at = xml.find("<DataItem", at)) != std::string::npos; ++at, ++references) {
    std::vector<std::uint64_t> wanted;
    std::istringstream stream(between("Dimensions=\"", "\"", at));
    for (std::uint64_t n; stream >> n;) wanted.push_back(n);
    const std::string dataset = between(">frames.h5:", "</DataItem>", at);
    EXPECT_EQ(file.shape(dataset), wanted) << dataset;
  }
  EXPECT_EQ(references, 3 * (7 + 4 + 2)); // grains, parts, ground
  // Parts are at their poses.
  const std::vector<double> parts = file.numbers("/000002/parts/position");
  EXPECT_EQ(parts[2], 2.0);
  EXPECT_EQ(parts[9], 5.0);
  EXPECT_EQ(file.numbers("/parts/triangles"), (std::vector<double>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(file.texts("/parts/kind", "names"), (std::vector<std::string>{"shoe", "chassis"}));
  EXPECT_EQ(file.numbers("/000001/grains/id").size(), 5u);
}

TEST_F(Output, FramesOfAsManyGrainsShareTheirListOfVertices) {
  RunWriter writer(folder_, setup::provenanceOf(scene()), channels(), {});
  writer.setParts({{"left shoe 0", PartKind::shoe, triangle()}, {"chassis", PartKind::chassis, triangle()}},
                  triangle());
  for (const int grains : {4, 4, 6, 4}) writer.frame(frame(0, grains));
  writer.finish({});
  const support::Hdf5File file = support::Hdf5File::open(folder_ / "frames.h5");
  EXPECT_EQ(file.numbers("/vertices/4"), (std::vector<double>{0, 1, 2, 3}));
  EXPECT_EQ(file.numbers("/vertices/6").size(), 6u);
  const std::string xml = contents(folder_ / "frames.xdmf");
  int uses = 0;
  for (std::size_t at = 0; (at = xml.find(">frames.h5:/vertices/4<", at)) != std::string::npos; ++at) ++uses;
  EXPECT_EQ(uses, 3);
  for (const char* frame : {"/000000", "/000001", "/000002", "/000003"})
    EXPECT_FALSE(file.has(std::string(frame) + "/grains/vertex")) << frame;
}

TEST_F(Output, SinkageCsvHasOneColumnAShoe) {
  {
    RunWriter writer(folder_, setup::provenanceOf(scene()), channels(), {});
    for (int r = 0; r < 4; ++r) writer.row(numbered(r));
    writer.finish({});
  }
  const std::vector<std::string> text = lines(contents(writeSinkageCsv(folder_ / "results.h5", folder_ / "deeper")));
  ASSERT_EQ(text.size(), 5u);
  EXPECT_EQ(text[0], "time [s],left 0 [m],left 1 [m],left 2 [m],right 0 [m],right 1 [m],right 2 [m]");
  const std::vector<double> row = cells(text[4]);
  EXPECT_EQ(row[1], 3.1);
  EXPECT_TRUE(std::isnan(row[3]));
}

TEST_F(Output, SinkageCsvOfSingleShoesHasThoseAlone) {
  {
    RunWriter writer(folder_, setup::provenanceOf(scene()), channels(), {});
    for (int r = 0; r < 2; ++r) writer.row(numbered(r));
    writer.finish({});
  }
  const fs::path file = writeSinkageCsv(folder_ / "results.h5", folder_, {2, 1});
  EXPECT_EQ(file, folder_ / "sinkage_shoes.csv");
  const std::vector<std::string> text = lines(contents(file));
  ASSERT_EQ(text.size(), 3u);
  EXPECT_EQ(text[0], "time [s],left 2 [m],left 1 [m],right 2 [m],right 1 [m]");
  EXPECT_EQ(cells(text[2])[2], 1.2);
  EXPECT_THROW(writeSinkageCsv(folder_ / "results.h5", folder_, {0, 3}), base::InputError) << "there are only three";
  EXPECT_THROW(requireShoes(folder_ / "results.h5", {3}), base::InputError);
  requireShoes(folder_ / "results.h5", {0, 2});
}

TEST_F(Output, SinkageCsvOfOneTrackHasNoOther) {
  {
    RunWriter writer(folder_, setup::provenanceOf(scene()), channels(), {});
    writer.row(numbered(1));
    writer.finish({});
  }
  const fs::path results = folder_ / "results.h5";
  EXPECT_EQ(lines(contents(writeSinkageCsv(results, folder_, {2, 1}, "left")))[0], "time [s],left 2 [m],left 1 [m]");
  EXPECT_EQ(lines(contents(writeSinkageCsv(results, folder_, {0}, "right")))[0], "time [s],right 0 [m]");
  EXPECT_THROW(requireShoes(results, {3}, "right"), base::InputError);
}

TEST_F(Output, TablesHaveNoRoundingOfTheProductOfAStep) {
  {
    RunWriter writer(folder_, setup::provenanceOf(scene()), channels(), {});
    RowBuilder row(channels());
    row.begin(5900, 5900 * 1e-4); // 0.5900000000000001
    writer.row(row.row());
    Summary summary;
    summary.simulatedTime = 5900 * 1e-4;
    writer.finish(summary);
  }
  EXPECT_TRUE(lines(contents(folder_ / "timeseries.csv"))[1].starts_with("5900,0.59,"));
  EXPECT_TRUE(lines(contents(writeSinkageCsv(folder_ / "results.h5", folder_)))[1].starts_with("0.59,"));
  EXPECT_NE(contents(folder_ / "manifest.json").find("\"simulated_time_s\": 0.59,"), std::string::npos);
  EXPECT_EQ(support::Hdf5File::open(folder_ / "results.h5").numbers("/series/time")[0], 5900 * 1e-4) << "unchanged";
}

TEST(ShoesNamed, AreNumbersAndRanges) {
  EXPECT_EQ(shoesNamed("10-13,20"), (std::vector<int>{10, 11, 12, 13, 20}));
  EXPECT_EQ(shoesNamed("5"), std::vector<int>{5});
  EXPECT_EQ(shoesNamed("3-3,1"), (std::vector<int>{3, 1}));
  for (const char* none : {"", "a", "1-", "-1", "4-2", "1,", "1;2", "1.5", "0-99999999", "2-3-4", "99999999999999"})
    EXPECT_THROW(shoesNamed(none), base::InputError) << none;
}

TEST_F(Output, SinkageOfAForeignFileIsAnInputError) {
  fs::create_directories(folder_);
  EXPECT_THROW(writeSinkageCsv(folder_ / "nothing.h5", folder_), base::InputError);
  std::ofstream(folder_ / "text.h5") << "not HDF5";
  EXPECT_THROW(writeSinkageCsv(folder_ / "text.h5", folder_), base::InputError);
  support::Hdf5File::create(folder_ / "foreign.h5").makeGroup("/vehicle");
  EXPECT_THROW(writeSinkageCsv(folder_ / "foreign.h5", folder_), base::InputError);
  RunWriter(folder_ / "bed", setup::provenanceOf(scene()), {{"ledger/residual", "J", "", 1, {}}}, {}).finish({});
  EXPECT_THROW(writeSinkageCsv(folder_ / "bed" / "results.h5", folder_), base::InputError);
  EXPECT_FALSE(fs::exists(folder_ / "sinkage.csv"));
}

} // namespace
} // namespace grouser::output
