// SPDX-License-Identifier: BSD-3-Clause
// Shape dimensions of a running gear: for the shipped vehicles they fit the meshes; others are rejected by name.
#include "vehicle/shape_check.hpp"

#include "spheredecomp/mesh.hpp"
#include "vehicle/shoe_points.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grouser::vehicle {
namespace {

VehicleSpec specOf(const std::string& name) {
  return readVehicleSpec({std::string(GROUSER_SOURCE_DIR) + "/assets/vehicles/" + name + ".toml", {}});
}

PartMeshes meshesOf(const VehicleSpec& spec) {
  const auto mesh = [&](const std::string& file) { return spheredecomp::importMesh(spec.meshFolder + "/" + file); };
  PartMeshes meshes;
  meshes.shoe = mesh(spec.shoe.mesh), meshes.sprocket = mesh(spec.sprocket.mesh);
  meshes.roadWheel = mesh(spec.roadWheel.mesh), meshes.idler = mesh(spec.idler.mesh);
  if (!spec.roller.x.empty()) meshes.roller = mesh(spec.roller.mesh);
  return meshes;
}

TEST(ShapeCheck, TheReadyVehiclesShapesAreTheirMeshes) {
  for (const char* name : {"light_tracked", "m113_like", "robot"}) {
    const VehicleSpec spec = specOf(name);
    ASSERT_TRUE(spec.shapes) << name;
    const auto fault = shapeFault(spec, meshesOf(spec));
    EXPECT_FALSE(fault) << name << ": " << fault->key << ' ' << fault->message;
  }
}

TEST(ShapeCheck, ALengthThatTheMeshDoesNotHaveIsRefusedByItsName) {
  const VehicleSpec good = specOf("light_tracked");
  const PartMeshes meshes = meshesOf(good);
  const std::pair<double GearShapes::*, const char*> lengths[] = {{&GearShapes::plateInner, "plate_inner"},
                                                                  {&GearShapes::plateOuter, "plate_outer"},
                                                                  {&GearShapes::hornLength, "horn_length"},
                                                                  {&GearShapes::hornWidth, "horn_width"},
                                                                  {&GearShapes::hornTipLength, "horn_tip_length"},
                                                                  {&GearShapes::hornTipWidth, "horn_tip_width"},
                                                                  {&GearShapes::bossRadius, "boss_radius"},
                                                                  {&GearShapes::bossInner, "boss_inner"},
                                                                  {&GearShapes::bossOuter, "boss_outer"},
                                                                  {&GearShapes::padTop, "pad_top"},
                                                                  {&GearShapes::grouserX, "grouser_x"},
                                                                  {&GearShapes::discInner, "disc_inner"},
                                                                  {&GearShapes::discOuter, "disc_outer"},
                                                                  {&GearShapes::ringInner, "ring_inner"},
                                                                  {&GearShapes::ringOuter, "ring_outer"},
                                                                  {&GearShapes::seatRadius, "seat_radius"},
                                                                  {&GearShapes::tipRadius, "tip_radius"}};
  for (const auto& [length, key] : lengths)
    for (const double off : {-4e-3, 4e-3}) {
      VehicleSpec spec = good;
      (*spec.shapes).*length += off;
      const auto fault = shapeFault(spec, meshes);
      ASSERT_TRUE(fault) << key << ' ' << off;
      EXPECT_EQ(fault->section, "shapes");
      EXPECT_NE(fault->message.find("[m]"), std::string::npos);
    }
}

TEST(ShapeCheck, LengthsThatContradictEachOtherAreRefused) {
  const VehicleSpec good = specOf("light_tracked");
  const auto keyOf = [&](auto change) {
    VehicleSpec spec = good;
    change(*spec.shapes);
    const auto fault = shapeFault(spec, {});
    return fault ? fault->key : "";
  };
  EXPECT_EQ(keyOf([](GearShapes&) {}), "");
  EXPECT_EQ(keyOf([](GearShapes& g) { g.plateInner = g.plateOuter; }), "plate_inner");
  EXPECT_EQ(keyOf([](GearShapes& g) { g.bossRadius = g.seatRadius; }), "boss_radius");
  EXPECT_EQ(keyOf([](GearShapes& g) { g.hornWidth = 2 * g.discInner; }), "horn_width");
  EXPECT_EQ(keyOf([](GearShapes& g) { g.ringInner = 0.18, g.ringOuter = 0.2; }), "ring_inner") << "beside the bosses";
  EXPECT_EQ(keyOf([](GearShapes& g) { g.flankRadius = 0.02; }), "flank_radius") << "a tooth with a hollow tip";
  EXPECT_EQ(keyOf([](GearShapes& g) { g.tipRadius = 0.24; }), "tip_radius") << "below the pins";
}

TEST(ShoePoints, StandForTheAreaOfTheirFacesAtAnySpacing) {
  const VehicleSpec spec = specOf("light_tracked");
  const auto areaBelow = [&](double spacing) {
    double lowest = 0, sum = 0;
    const std::vector<contact::SurfaceSample> points = shoePoints(spec, spacing);
    for (const contact::SurfaceSample& p : points)
      lowest = std::min(lowest, static_cast<double>(p.centre.z - p.radius));
    EXPECT_NEAR(lowest, spec.shoe.padBottom - spec.shoe.grouserHeight, 1e-7);
    for (const contact::SurfaceSample& p : points)
      if (static_cast<double>(p.centre.z - p.radius) < lowest + 1e-6) sum += static_cast<double>(p.area);
    return sum;
  };
  const double tips = 2 * (spec.shapes->grouserWidth - 2 * spec.shapes->chamfer) * 2 * spec.shoe.padHalfWidth;
  for (const double spacing : {0.02, 0.0077, 0.003}) EXPECT_NEAR(areaBelow(spacing), tips, 1e-6 * tips) << spacing;
}

} // namespace
} // namespace grouser::vehicle
