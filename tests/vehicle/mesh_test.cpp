// SPDX-License-Identifier: BSD-3-Clause
// A separate generator creates the meshes: these tests compare meshes and specification.
#include "base/math.hpp"
#include "vehicle/part_meshes.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

using namespace grouser;
using base::Vec3d;

namespace {

/// Meshes are facets of smooth shapes with corners on the shape; coordinates are accurate to 0.1 mm or
/// better.
constexpr double kFacet = 1e-4;

vehicle::VehicleSpec meshSpec() {
  return vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml");
}

std::vector<Vec3d> vertices(const std::string& mesh) {
  std::ifstream file(meshSpec().meshFolder + "/" + mesh);
  std::vector<Vec3d> points;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    Vec3d p;
    if (words >> key && key == "v" && words >> p.x >> p.y >> p.z) points.push_back(p);
  }
  EXPECT_FALSE(points.empty()) << mesh;
  return points;
}

double radius(const Vec3d& p) { return std::sqrt(p.x * p.x + p.z * p.z); }

double largestRadius(const std::string& mesh) {
  double r = 0;
  for (const Vec3d& p : vertices(mesh)) r = std::max(r, radius(p));
  return r;
}

} // namespace

TEST(Meshes, Shoe_HasTheSpecsHeights) {
  const vehicle::ShoeSpec shoe = meshSpec().shoe;
  Vec3d low{1, 1, 1}, high{-1, -1, -1};
  for (const Vec3d& p : vertices(shoe.mesh)) low = base::min(low, p), high = base::max(high, p);
  EXPECT_NEAR(low.z, shoe.padBottom - shoe.grouserHeight, kFacet);
  EXPECT_NEAR(high.z, shoe.plateTop + shoe.hornHeight, kFacet);
  EXPECT_NEAR(low.x, -shoe.halfLength, kFacet);
  EXPECT_GT(high.x, 0.5 * shoe.pitch) << "the bosses are at the front pin";
  EXPECT_NEAR(low.y, -high.y, kFacet);
  EXPECT_GE(high.y, shoe.padHalfWidth);
}

TEST(Meshes, Wheels_HaveTheSpecsRadii) {
  const vehicle::VehicleSpec s = meshSpec();
  EXPECT_NEAR(largestRadius(s.roadWheel.mesh), s.roadWheel.radius, kFacet);
  EXPECT_NEAR(largestRadius(s.roller.mesh), s.roller.radius, kFacet);
  EXPECT_NEAR(largestRadius(s.idler.mesh), s.idler.radius, kFacet);
}

TEST(Meshes, Sprocket_HasItsGapsWhereTheWrapPutsThePins) {
  const vehicle::VehicleSpec s = meshSpec();
  const double tooth = 2 * base::kPi / s.sprocket.teeth;
  double rim = 0;
  std::vector<double> bottom(s.sprocket.teeth, 1.0);
  for (const Vec3d& p : vertices(s.sprocket.mesh)) {
    const double r = radius(p), gaps = base::atan2(p.z, p.x) / tooth;
    rim = std::max(rim, r);
    const double nearest = std::floor(gaps + 0.5);
    // Profile corners in the middle of a gap, away from hub and axle.
    if (std::fabs(gaps - nearest) > 0.01 || r < 0.9 * s.sprocketPinRadius()) continue;
    const int k = (static_cast<int>(nearest) + s.sprocket.teeth) % s.sprocket.teeth;
    bottom[k] = std::min(bottom[k], r);
  }
  // The seat arc of radius 18.5 mm about the pin; the tip is 20 mm beyond it.
  for (const double r : bottom) EXPECT_NEAR(r, s.sprocketPinRadius() - 0.0185, kFacet);
  EXPECT_NEAR(rim, s.sprocketPinRadius() + 0.020, kFacet);
}

TEST(Meshes, VerticesInAnotherUnitThanMetres_AreNamedWithTheFactor) {
  for (const char* name : {"light_tracked", "m113_like", "robot"}) {
    const vehicle::VehicleSpec spec =
        vehicle::readVehicleSpec(std::string(GROUSER_SOURCE_DIR "/assets/vehicles/") + name + ".toml");
    const std::pair<const char*, std::string> parts[] = {{"chassis", spec.chassis.mesh},
                                                         {"shoe", spec.shoe.mesh},
                                                         {"sprocket", spec.sprocket.mesh},
                                                         {"road_wheel", spec.roadWheel.mesh},
                                                         {"idler", spec.idler.mesh}};
    for (const auto& [section, file] : parts) {
      const auto fault = [&, section = section, file = file](double perMetre) {
        base::TriangleMesh mesh;
        std::ifstream in(spec.meshFolder + "/" + file);
        for (std::string line; std::getline(in, line);) {
          std::istringstream words(line);
          std::string key;
          Vec3d p;
          if (words >> key && key == "v" && words >> p.x >> p.y >> p.z) mesh.vertices.push_back(p * perMetre);
        }
        const std::optional<vehicle::SpecFault> found = vehicle::unitFault(section, spec, mesh);
        return found ? found->section + "." + found->key + " " + found->message : std::string();
      };
      EXPECT_EQ(fault(1), "") << name << " " << section;
      EXPECT_EQ(fault(1.3), "") << name << " " << section << ": another size, not another unit";
      const std::string mm = fault(1000), cm = fault(100), inches = fault(1 / 0.0254);
      EXPECT_EQ(mm.find(std::string(section) + ".mesh has a"), 0u) << mm;
      EXPECT_NE(mm.find("vertices are in millimetres; convert all meshes to metres (scale by 0.001)"),
                std::string::npos)
          << name << " " << section << mm;
      EXPECT_NE(cm.find("in centimetres"), std::string::npos) << name << " " << section << cm;
      EXPECT_NE(inches.find("in inches"), std::string::npos) << name << " " << section << inches;
      if (std::string(section) == "chassis") continue;
      EXPECT_NE(fault(1 / 0.3048).find("in feet"), std::string::npos) << name << " " << section << fault(1 / 0.3048);
    }
  }
}
