// SPDX-License-Identifier: BSD-3-Clause
// Surfaces in contact with a vehicle, their friction, and their heights.
#include "runs/setup/obstacles.hpp"

#include "base/error.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/scene_surfaces.hpp"
#include "runs/setup/simulation_setup.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fmt/format.h>

namespace grouser::setup {
namespace {

/// On level rigid ground at height 0; `vehicle`: more keys of that section.
scene::Scene sceneWith(const std::string& more, const std::string& vehicle = {}) {
  return parseScene(
      "version = 1\n[run]\nduration = 1\ntime_step = 1e-4\n[material.steel]\nstiffness = 1e6\ndensity = 7800\n"
      "friction = 0.5\n[material.ice]\nstiffness = 1e6\nfriction = 0.05\n[terrain]\nkind = \"rigid\"\n"
      "heightmap = \"heightmaps/flat.png\"\nsize = [12, 6]\nheight_range = [0, 0]\nmaterial = \"steel\"\n"
      "[vehicle]\nspec = \"vehicles/light_tracked.toml\"\nsphere_radius = 0.03\n" +
          vehicle + more,
      GROUSER_SOURCE_DIR "/tests/scenes/obstacles.toml");
}

std::string box(const std::string& more = {}) {
  return "[[box]]\nposition = [5, 0, 0.1]\nsize = [2, 1, 0.2]\nmaterial = \"ice\"\n" + more;
}

TEST(Obstacles, WhatMovesWhereThereAreNoGrainsIsRefused) {
  try {
    sceneWith(box("velocity = [0, 0, 1]\n"));
    FAIL() << "accepted";
  } catch (const base::InputError& error) {
    const std::string said = error.what();
    for (const char* word :
         {"box.0", "moves, but vehicle and bodies have contact with fixed surfaces only", "remove the motion"})
      EXPECT_NE(said.find(word), std::string::npos) << word << " in: " << said;
  }
}

TEST(Obstacles, AreWhatRests) {
  const std::vector<coupling::Obstacle> all =
      obstaclesOf(sceneWith("[[plane]]\npoint = [0, 3, 0]\nnormal = [0, -1, 0]\nmaterial = \"steel\"\n" + box() +
                            "[[grain]]\nposition = [9, 0, 3]\nradius = 0.1\nmaterial = \"steel\"\n[[cylinder]]\n"
                            "position = [9, 9, 0]\nradius = 1\nlength = 1\nmaterial = \"steel\"\n"
                            "velocity = [0, 0, 1]\n"));
  ASSERT_EQ(all.size(), 2u) << "all except the cylinder";
  EXPECT_EQ(all[0].surface.name, "box0");
  ASSERT_TRUE(all[0].amongSurfaces);
  EXPECT_EQ(all[1].surface.name, "plane0") << "a wall for grains";
  EXPECT_FALSE(all[1].amongSurfaces);
  EXPECT_NEAR(all[1].surface.start.toWorld({0, 0, 1}).y, 2, 1e-12) << "its z axis is its normal";
}

TEST(Obstacles, FrictionIsTheVehiclesFileOrThePairOfMaterials) {
  EXPECT_EQ(obstaclesOf(sceneWith(box())).front().friction, 0.8) << "friction_ground";
  EXPECT_EQ(obstaclesOf(sceneWith(box() + "[spec.contact]\nfriction_ground = 0.4\n")).front().friction, 0.4)
      << "the scene overrides it";
  EXPECT_EQ(obstaclesOf(sceneWith(box(), "material = \"steel\"\n")).front().friction, 0.05) << "the smaller";
  EXPECT_EQ(obstaclesOf(sceneWith(box() + "[contact.\"ice|steel\"]\nfriction = 0.3\n", "material = \"steel\"\n"))
                .front()
                .friction,
            0.3);
}

TEST(Obstacles, TheHullTouchesOnRigidGroundUnlessItIsSaid) {
  EXPECT_TRUE(hullTouches(sceneWith("")));
  EXPECT_FALSE(hullTouches(sceneWith("", "hull_touches = false\n")));
  EXPECT_TRUE(hullTouches(sceneWith("", "hull_touches = \"auto\"\n")));
}

coupling::SurfaceSetup only(const std::string& section) { return surfacesOf(sceneWith(section)).front(); }

TEST(TopOf, ABoxThatIsTurned) {
  const coupling::SurfaceSetup ramp =
      only("[[box]]\nposition = [5, 0, 0]\nsize = [4, 2, 1]\naxis = [0, 1, 0]\nangle = -30\nmaterial = \"ice\"\n");
  const double slope = std::tan(std::acos(-1.0) / 6), up = 0.5 / std::cos(std::acos(-1.0) / 6);
  for (const double x : {-1.0, 0.0, 0.7}) EXPECT_NEAR(coupling::topOf(ramp, 5 + x, 0.3), up + slope * x, 1e-12);
  EXPECT_EQ(coupling::topOf(ramp, 5, 1.01), -INFINITY) << "beside the ramp";
  EXPECT_EQ(coupling::topOf(ramp, 7.1, 0), -INFINITY) << "beyond its end";
}

TEST(TopOf, ALogAndAPost) {
  const coupling::SurfaceSetup log =
      only("[[cylinder]]\nposition = [5, 0, 0.1]\naxis = [0, 1, 0]\nradius = 0.3\nlength = 2\nmaterial = \"ice\"\n");
  EXPECT_NEAR(coupling::topOf(log, 5.18, 0.9), 0.1 + 0.24, 1e-12);
  EXPECT_EQ(coupling::topOf(log, 5.31, 0), -INFINITY);
  EXPECT_EQ(coupling::topOf(log, 5, 1.01), -INFINITY);
  const coupling::SurfaceSetup post =
      only("[[cylinder]]\nposition = [5, 0, 0.5]\nradius = 0.3\nlength = 1\nmaterial = \"ice\"\n");
  EXPECT_NEAR(coupling::topOf(post, 5.2, 0.2), 1, 1e-12);
  EXPECT_EQ(coupling::topOf(post, 5.25, 0.25), -INFINITY);
  EXPECT_EQ(coupling::topOf(only("[[cylinder]]\nposition = [5, 0, 0.5]\nradius = 3\nlength = 1\nhollow = true\n"
                                 "material = \"ice\"\n"),
                            5, 0),
            -INFINITY)
      << "an arena is not ground";
}

TEST(TopOf, PlanesThatLookUp) {
  const coupling::SurfaceSetup ramp =
      only("[[plane]]\npoint = [5, 0, 0]\nnormal = [-1, 0, 2]\nmaterial = \"ice\"\nname = \"ramp\"\n");
  EXPECT_NEAR(coupling::topOf(ramp, 7, 1), 1, 1e-12);
  EXPECT_NEAR(coupling::topOf(ramp, 3, 1), -1, 1e-12);
  for (const char* normal : {"[-1, 0, 0]", "[0, 0, -1]"})
    EXPECT_EQ(coupling::topOf(
                  only(fmt::format("[[plane]]\npoint = [5, 0, 0]\nnormal = {}\nmaterial = \"ice\"\nname = \"wall\"\n",
                                   normal)),
                  6, 0),
              -INFINITY);
}

TEST(TopOf, AMeshIsItsTriangles) {
  const coupling::SurfaceSetup hull =
      only("[[mesh]]\nfile = \"meshes/chassis.obj\"\nposition = [5, 0, 1]\naxis = [0, 0, 1]\nangle = 90\n"
           "material = \"ice\"\nsphere_radius = 0.05\n");
  EXPECT_NEAR(coupling::topOf(hull, 5, 1), 1.75, 1e-12) << "deck height";
  EXPECT_NEAR(coupling::topOf(hull, 5 + 0.3, 2.8), 1 + 0.3 + 0.1 * 0.2, 1e-6)
      << "on the glacis, 0.05 m before its lower edge";
  EXPECT_EQ(coupling::topOf(hull, 6.3, 1), -INFINITY);
}

TEST(WithObstacles, WhatStandsIsGroundAndWhatHangsIsNot) {
  const auto ground = [](double, double) { return 0.1; };
  const auto heights = coupling::withObstacles(ground, obstaclesOf(sceneWith(box())));
  EXPECT_EQ(heights(5, 0), 0.2);
  EXPECT_EQ(heights(6.01, 0), 0.1);
  std::string roof = box();
  roof.replace(roof.find("0.1]"), 4, "2.1]");
  EXPECT_EQ(coupling::withObstacles(ground, obstaclesOf(sceneWith(roof)))(5, 0), 0.1);
}

TEST(Obstacles, AMeshBesideAVehicleOnGrainsIsRefused) {
  try {
    parseScene("version = 1\n[run]\nduration = 1\n[material.soil]\nstiffness = 1e6\n[terrain]\n"
               "heightmap = \"heightmaps/flat.png\"\nsize = [12, 6]\nheight_range = [0, 0]\nmaterial = \"soil\"\n"
               "grain_radius = 0.05\nlayers = 2\narrangement = \"lattice\"\n[vehicle]\n"
               "spec = \"vehicles/light_tracked.toml\"\n[[mesh]]\nfile = \"meshes/chassis.obj\"\nmaterial = \"soil\"\n",
               GROUSER_SOURCE_DIR "/tests/scenes/obstacles.toml");
    FAIL() << "accepted";
  } catch (const base::InputError& error) {
    const std::string said = error.what();
    for (const char* word :
         {"mesh.0", "is incompatible with [vehicle] on grains", "use boxes and cylinders, or rigid ground"})
      EXPECT_NE(said.find(word), std::string::npos) << word << " in: " << said;
  }
}

} // namespace
} // namespace grouser::setup
