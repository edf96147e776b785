// SPDX-License-Identifier: BSD-3-Clause
#include "assets/generator/parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

namespace grouser::assets {
namespace {

/// All committed files: of the vehicle, and of rigs.
std::vector<NamedMesh> allParts() {
  std::vector<NamedMesh> parts = vehicleParts();
  for (const auto& more : {m113Parts(), robotParts(), rigParts()}) parts.insert(parts.end(), more.begin(), more.end());
  return parts;
}

/// Volume of a closed mesh, its triangles counter-clockwise from outside.
double volumeOf(const TriangleMesh& mesh) {
  double six = 0;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const auto &a = mesh.vertices[mesh.indices[t]], &b = mesh.vertices[mesh.indices[t + 1]],
               &c = mesh.vertices[mesh.indices[t + 2]];
    six += dot(a, cross(b, c));
  }
  return six / 6;
}

TEST(RigMeshes, GrouserWheel_HasTheVolumeOfDrumAndBlades) {
  GrouserWheelDims dims;
  dims.facets = 200; // nearly round
  const double r = dims.radius, b = dims.width, t = dims.grouserThickness, h = dims.grouserHeight;
  const double drum = 3.14159265358979 * r * r * b, blades = dims.grousers * t * h * b;
  // A blade's foot removes t^3 / 12 r of a drum's rim: a part in a million of the drum.
  EXPECT_NEAR(volumeOf(grouserWheel(dims)), drum + blades, 1e-5 * drum);
  double tip = 0;
  for (const auto& v : grouserWheel().vertices) tip = std::max(tip, v.x);
  EXPECT_NEAR(tip, r + h, 1e-12) << "the first blade is on the +x side, with a plane end";
  EXPECT_THROW(grouserWheel({0.1, 0.1, 100, 0.01, 0.01, 1}), std::invalid_argument);
}

TEST(VehicleMeshes, Generator_ReproducesCommittedFilesByteForByte) {
  for (const NamedMesh& part : allParts()) {
    const std::string path = std::string(GROUSER_SOURCE_DIR) + "/assets/meshes/" + part.name + ".obj";
    std::ifstream file(path, std::ios::binary);
    ASSERT_TRUE(file) << path;
    std::stringstream committed;
    committed << file.rdbuf();
    const std::string made = toObj(part);
    // Compared as one boolean: a failed text comparison would print 100 kB.
    EXPECT_TRUE(made == committed.str()) << part.name << ".obj differs; if meant, run grouser_assets assets/meshes";
    EXPECT_LT(made.size(), 200000u) << part.name;
  }
}

TEST(VehicleMeshes, EveryEdge_HasExactlyTwoTrianglesInOppositeDirections) {
  for (const NamedMesh& part : allParts()) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    const auto& index = part.mesh.indices;
    for (std::size_t t = 0; t < index.size(); t += 3)
      for (std::size_t k = 0; k < 3; ++k) ++edges[{index[t + k], index[t + (k + 1) % 3]}];
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1) << part.name;
      ASSERT_TRUE(edges.count({edge.second, edge.first})) << part.name;
    }
  }
}

TEST(VehicleMeshes, WheelRim_HasTheMeanRadiusAsked) {
  const WheelDims dims{0.19, 0.10, 128};
  const TriangleMesh mesh = wheel(dims);
  double rim = 0;
  for (const auto& v : mesh.vertices) rim = std::max(rim, std::sqrt(v.x * v.x + v.z * v.z));
  // Mean over the angle of the polygon's radius, by the midpoint rule within one facet; the rule's error is
  // d^2/24n^2.
  const double d = 3.14159265358979 / dims.facets;
  double mean = 0;
  const int n = 1000;
  for (int i = 0; i < n; ++i) mean += rim * std::cos(d) / std::cos(d * (i + 0.5) / n) / n;
  EXPECT_NEAR(mean, dims.radius, 1e-9);
}

TEST(VehicleMeshes, SprocketProfile_HasTenTeethAtTheirRadii) {
  const SprocketDims dims;
  double tip = 0, bottom = 1;
  for (const auto& v : sprocket(dims).vertices) {
    const double r = std::sqrt(v.x * v.x + v.z * v.z);
    tip = std::max(tip, r);
    if (r > dims.hubRadius + 1e-6) bottom = std::min(bottom, r);
  }
  // The tip's coordinates are rounded to 0.1 mm in their table.
  EXPECT_NEAR(tip, dims.landRadius, 1e-4);
  EXPECT_NEAR(bottom, dims.pinRadius - dims.seatRadius, 1e-12);
}

} // namespace
} // namespace grouser::assets
