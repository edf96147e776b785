// SPDX-License-Identifier: BSD-3-Clause
// Deformable soil as triangles, in frames.h5, and as maps and a section in results.h5.
#include "runs/output/soil_surface.hpp"

#include "base/error.hpp"
#include "runs/output/frames_file.hpp"
#include "runs/output/frames_reader.hpp"
#include "runs/output/soil_datasets.hpp"
#include "runs/output/soil_result.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>

namespace grouser::output::soil_surface {
namespace {

constexpr double kSpacing = 0.02;
constexpr double kRut = 0.03; ///< [m] deep

/// A rut along x from 0 to 1 m, 0.2 m wide, with pressure on its last 0.3 m.
coupling::GroundFields rut() {
  coupling::GroundFields fields;
  fields.spacing = kSpacing;
  for (std::int32_t j = -5; j <= 5; ++j)
    for (std::int32_t i = 0; i <= 50; ++i) {
      coupling::SoilNode node;
      node.i = i, node.j = j, node.sinkage = kRut, node.maxPressure = 4e4;
      if (i >= 35) node.pressure = 4e4, node.shear = {1e4, 0, 0};
      fields.nodes.push_back(node);
    }
  return fields;
}

terrain::HeightField level(double height = 0) { return terrain::HeightField::flat({-3.01, 4.03, -2.03, 2}, height); }

double areaOf(const SoilSurface& s) {
  double area = 0;
  for (std::size_t t = 0; t < s.mesh.indices.size(); t += 3) {
    const auto corner = [&](std::size_t k) { return s.mesh.vertices[s.mesh.indices[t + k]]; };
    const double doubled = cross(corner(1) - corner(0), corner(2) - corner(0)).z;
    EXPECT_GE(doubled, -1e-15) << "all triangles face up";
    area += 0.5 * doubled;
  }
  return area;
}

TEST(SoilSurface, CoversTheTerrainOnceAndWithoutGaps) {
  const terrain::HeightField ground = level(0.5);
  const SoilSurface s = soilSurface(rut(), ground);
  EXPECT_NEAR(areaOf(s), ground.area().width() * ground.area().length(), 1e-9);
  // Each edge inside the border belongs to two triangles: no vertex lies on the edge of a neighbour.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t t = 0; t < s.mesh.indices.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(s.mesh.indices[t + k], s.mesh.indices[t + (k + 1) % 3])];
  const terrain::Rectangle& a = ground.area();
  for (const auto& [edge, count] : edges) {
    const base::Vec3d p = s.mesh.vertices[edge.first], q = s.mesh.vertices[edge.second];
    const bool isBorder =
        (p.x == q.x && (p.x == a.xMin || p.x == a.xMax)) || (p.y == q.y && (p.y == a.yMin || p.y == a.yMax));
    ASSERT_TRUE(isBorder || count == 2) << p.x << ' ' << p.y << " to " << q.x << ' ' << q.y;
  }
}

TEST(SoilSurface, HasTheRutAtNodeSpacingAndFewTrianglesElsewhere) {
  const SoilSurface s = soilSurface(rut(), level(0.5));
  int deep = 0, loaded = 0;
  for (std::size_t v = 0; v < s.mesh.vertices.size(); ++v) {
    const base::Vec3d& p = s.mesh.vertices[v];
    const bool inRut = p.x > -1e-9 && p.x < 1 + 1e-9 && std::fabs(p.y) < 0.1 + 1e-9;
    EXPECT_NEAR(p.z, inRut ? 0.5 - kRut : 0.5, 1e-12);
    EXPECT_FLOAT_EQ(s.sinkage[v], inRut ? static_cast<float>(kRut) : 0);
    deep += inRut, loaded += s.pressure[v] > 0;
    EXPECT_EQ(s.pressure[v] > 0, s.shear[v].x > 0);
  }
  EXPECT_EQ(deep, 51 * 11);
  EXPECT_EQ(loaded, 16 * 11);
  const double cell = 7.04 * 4.03 / (kSpacing * kSpacing);
  EXPECT_LT(static_cast<double>(s.mesh.vertices.size()), 0.2 * cell) << "a fraction of the nodes of the terrain";
}

using SoilFrames = test::FolderTest;

TEST_F(SoilFrames, AreReadBackAndTakeThePlaceOfTheGroundInParaView) {
  Frame frame;
  frame.soil = std::make_shared<SoilSurface>(soilSurface(rut(), level()));
  const base::TriangleMesh ground{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}};
  {
    FramesFile file(folder_, {}, ground);
    file.add(frame);
    frame.soil.reset();
    file.add(frame);
  }
  const FramesReader reader(folder_ / "frames.h5");
  const std::shared_ptr<const SoilSurface> soil = reader.read(0).soil;
  ASSERT_TRUE(soil);
  EXPECT_FALSE(reader.read(1).soil);
  const SoilSurface wanted = soilSurface(rut(), level());
  EXPECT_EQ(soil->mesh.indices, wanted.mesh.indices);
  EXPECT_EQ(soil->sinkage, wanted.sinkage);
  EXPECT_EQ(soil->pressure, wanted.pressure);
  EXPECT_EQ(soil->maxPressure, wanted.maxPressure);
  ASSERT_EQ(soil->shear.size(), wanted.shear.size());
  for (std::size_t v = 0; v < soil->shear.size(); ++v) EXPECT_EQ(soil->shear[v].x, wanted.shear[v].x);
  const std::uint64_t raw = bytesOfSoil(wanted);
  EXPECT_LT(std::filesystem::file_size(folder_ / "frames.h5"), raw / 3) << "compressed";
  const std::string xml = test::contents(folder_ / "frames.xdmf");
  const support::Hdf5File file = support::Hdf5File::open(folder_ / "frames.h5");
  for (const char* name : {"triangles", "position", "sinkage", "pressure", "max_pressure", "shear", "shear_vector"}) {
    const std::string dataset = fmt::format("/000000/soil/{}", name);
    EXPECT_NE(xml.find("frames.h5:" + dataset + "<"), std::string::npos) << dataset;
    EXPECT_TRUE(file.has(dataset)) << dataset;
  }
  const std::size_t first = xml.find("/ground/triangles"),
                    second = xml.find("Grid Name=\"step", xml.find("/000000/soil"));
  EXPECT_GT(first, second) << "only the second frame shows undisturbed ground";
}

TEST_F(SoilFrames, DamagedDataAreAnInputError) {
  {
    support::Hdf5File file = support::Hdf5File::create(folder_ / "frames.h5");
    SoilSurface soil = soilSurface(rut(), level());
    soil.pressure.pop_back();
    writeSoil(file, "/000000", soil);
  }
  const support::Hdf5File file = support::Hdf5File::open(folder_ / "frames.h5");
  EXPECT_THROW(readSoil(file, "/000000"), base::InputError);
}

TEST(SoilResult, HasMapsOverTheTouchedAreaAndASectionBehindTheTracks) {
  coupling::GroundFields fields = rut();
  for (coupling::SoilNode& node : fields.nodes)
    if (node.pressure > 0) node.sinkage = 1.1 * kRut; // elastic, under the tracks
  const SoilResult r = soilResult(fields, Course{{0.8, 0, 0.4}, {1, 0, 0}});
  EXPECT_EQ(r.columns, 51u);
  EXPECT_EQ(r.rows, 11u);
  EXPECT_NEAR(r.origin[0], 0, 1e-12);
  EXPECT_NEAR(r.origin[1], -0.1, 1e-12);
  EXPECT_EQ(r.pressure[5 * 51 + 34], 0);
  EXPECT_EQ(r.pressure[5 * 51 + 35], 4e4f);
  EXPECT_EQ(r.shear[5 * 51 + 35], 1e4f);
  ASSERT_EQ(r.sectionOffset.size(), r.sectionSinkage.size());
  for (std::size_t k = 0; k < r.sectionOffset.size(); ++k) {
    const double side = std::fabs(r.sectionOffset[k]);
    if (side > 0.1 - 1e-9 && side < 0.12 + 1e-9) continue; // the edge
    EXPECT_NEAR(r.sectionSinkage[k], side < 0.1 ? kRut : 0, 1e-9) << r.sectionOffset[k];
  }
  EXPECT_GT(r.sectionOffset.back(), 0.3);
}

TEST(SoilResult, LargeAreasKeepEverySecondNodeOrFewer) {
  coupling::GroundFields fields = rut();
  coupling::SoilNode far = fields.nodes.back();
  far.i = 6000, far.j = 3000;
  fields.nodes.push_back(far);
  const SoilResult r = soilResult(fields);
  EXPECT_NEAR(r.spacing[0], 3 * kSpacing, 1e-12);
  EXPECT_LE(r.columns * r.rows, 4'000'000u);
  EXPECT_EQ(r.sinkage[0], static_cast<float>(kRut));
  EXPECT_TRUE(r.sectionOffset.empty()) << "a section requires a vehicle";
  EXPECT_TRUE(soilResult({}).sinkage.empty());
}

} // namespace
} // namespace grouser::output::soil_surface
