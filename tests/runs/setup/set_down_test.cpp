// SPDX-License-Identifier: BSD-3-Clause
// Initial position of a vehicle, start of its drive, and surfaces in its path.
#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/placement.hpp"
#include "runs/setup/vehicle_setup.hpp"
#include "runs/setup/vehicle_surroundings.hpp"
#include "vehicle/assembly.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

namespace grouser::setup {
namespace {

using base::Vec3d;

vehicle::VehicleSpec spec() {
  return vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml");
}

/// A scene on level, rigid ground, or on a bed; `more` adds keys.
scene::Scene setDownScene(const std::string& more, bool bed = false) {
  return parseScene(
      "version = 1\n[run]\nduration = 4\ntime_step = 1e-4\n[material.soil]\nstiffness = 1e6\n[terrain]\n"
      "heightmap = \"heightmaps/flat.png\"\nsize = [12, 6]\nheight_range = [0, 0]\nmaterial = \"soil\"\n" +
          std::string(bed ? "grain_radius = 0.05\nlayers = 2\narrangement = \"lattice\"\nfloor_grains = "
                            "false\nwall_friction = 0.5\n"
                          : "kind = \"rigid\"\n") +
          "[vehicle]\nspec = \"vehicles/light_tracked.toml\"\nsphere_radius = 0.03\n" + more,
      GROUSER_SOURCE_DIR "/tests/scenes/set_down.toml");
}

/// Smallest normal distance of the lowest grousers' plane from the ground, over a fine grid under both tracks.
double clearanceOver(const base::Pose& pose, const std::function<double(double, double)>& ground) {
  const vehicle::VehicleSpec s = spec();
  const Vec3d up = rotate(pose.orientation, {0, 0, 1});
  double least = 1e9;
  for (int i = 0; i <= 200; ++i)
    for (int j = -20; j <= 20; ++j)
      for (const double side : {-1.0, 1.0}) {
        const Vec3d p = pose.toWorld({0.345 + 2.18 * i / 200, side * s.trackOffset + 0.007 * j, s.groundHeight()});
        least = std::min(least, dot(p - Vec3d{p.x, p.y, ground(p.x, p.y)}, up));
      }
  return least;
}

TEST(SetDown, OnLevelGround_StandsLevel) {
  const base::Pose pose = coupling::setDown(spec(), {1, 2, 0.3}, 0.002, [](double, double) { return 0.7; });
  const base::Pose level = vehicle::placeOnGround(spec(), 1, 2, 0.702, 0, 0.3);
  EXPECT_EQ(pose.position, level.position);
  EXPECT_EQ(pose.orientation.w, level.orientation.w);
  EXPECT_EQ(pose.orientation.x, 0);
  EXPECT_EQ(pose.orientation.z, level.orientation.z);
}

TEST(SetDown, OnASlope_LiesAlongIt) {
  for (const double heading : {0.0, 0.8, -2.0}) {
    const double a = 0.12, b = 0.1763;
    const auto ground = [&](double x, double y) { return 0.2 + a * x + b * y; };
    const base::Pose pose = coupling::setDown(spec(), {2, 1, heading}, 0.002, ground);
    const Vec3d up = rotate(pose.orientation, {0, 0, 1}), ahead = rotate(pose.orientation, {1, 0, 0});
    const double n = std::sqrt(1 + a * a + b * b);
    EXPECT_NEAR(up.x, -a / n, 1e-12);
    EXPECT_NEAR(up.y, -b / n, 1e-12);
    EXPECT_NEAR(ahead.y * base::cos(heading) - ahead.x * base::sin(heading), 0, 1e-12) << "over its heading";
    EXPECT_GT(ahead.x * base::cos(heading) + ahead.y * base::sin(heading), 0.9);
    EXPECT_EQ(pose.position.x, 2);
    EXPECT_NEAR(clearanceOver(pose, ground), 0.002, 1e-12);
  }
}

TEST(SetDown, OnAMereSideSlope_LiesAlongIt) {
  for (const double slope : {0.1763, -0.1}) {
    const auto ground = [&](double, double y) { return slope * y; };
    const base::Pose pose = coupling::setDown(spec(), {2, 0.5, 0}, 0.002, ground);
    const Vec3d up = rotate(pose.orientation, {0, 0, 1});
    EXPECT_NEAR(up.x, 0, 1e-12);
    EXPECT_NEAR(up.y, -slope / std::sqrt(1 + slope * slope), 1e-12);
    EXPECT_NEAR(clearanceOver(pose, ground), 0.002, 1e-12);
  }
}

TEST(SetDown, OverARidge_IsClearOfItsTop) {
  // A ridge across the path and a side slope: the attitude follows the mean plane, the clearance the ridge.
  const auto ground = [](double x, double y) {
    const double d = (x - 3.2) / 0.3;
    return 0.05 * y + (d * d < 1 ? 0.06 * (1 - d * d) : 0.0);
  };
  const base::Pose pose = coupling::setDown(spec(), {2, 0, 0}, 0.002, ground);
  const double clear = clearanceOver(pose, ground);
  EXPECT_LT(clear, 0.0022);
  EXPECT_GT(clear, 0.0015); // the grid spacing is 55 mm: the crest is between two points, 0.06 (0.027 / 0.3)^2 = 0.5 mm
}

TEST(DriveStart, ATableIsFollowedAsGiven) {
  const std::string table = "[driver.table]\ntime = [0, 0.2]\nleft = [0, 2]\nright = [0, 1]\n";
  const vehicle::Driver driver(vehicleSetup(setDownScene("[driver]\ndrive_start = 0.5\n" + table)).driver);
  EXPECT_NEAR(driver.at(0.6).sprocketSpeed[0], 1, 1e-12);
  EXPECT_NEAR(driver.at(0.65).sprocketSpeed[1], 0.75, 1e-12);
  // A requested ramp applies to a table, too.
  const vehicle::Driver ramped(
      vehicleSetup(setDownScene("[driver]\ndrive_start = 0.5\ndrive_ramp = 0.2\n" + table)).driver);
  EXPECT_NEAR(ramped.at(0.6).sprocketSpeed[0], 0.5, 1e-12);
  // The default ramp of constant speeds is 0.3 s.
  const vehicle::Driver constant(
      vehicleSetup(setDownScene("[driver]\ndrive_start = 0.5\nsprocket_speed = 2\n")).driver);
  EXPECT_NEAR(constant.at(0.65).sprocketSpeed[0], 1, 1e-12);
}

TEST(DriveStart, WaitsForRestUnlessItIsGivenOrTheHullIsHeld) {
  EXPECT_TRUE(vehicleSetup(setDownScene("[driver]\nsprocket_speed = 1\n")).driver.rest.has_value());
  EXPECT_FALSE(vehicleSetup(setDownScene("[driver]\nsprocket_speed = 1\ndrive_start = 0.5\n")).driver.rest.has_value());
  EXPECT_FALSE(
      vehicleSetup(setDownScene("chassis = \"fixed\"\n[driver]\nsprocket_speed = 1\n")).driver.rest.has_value());
  const auto rest =
      vehicleSetup(setDownScene("[driver]\nrest_speed = 0.02\nrest_load = 0.1\nrest_time_limit = 3\n")).driver.rest;
  ASSERT_TRUE(rest);
  EXPECT_EQ(rest->speed, 0.02);
  EXPECT_EQ(rest->load, 0.1);
  EXPECT_EQ(rest->timeLimit, 3);
}

/// Error for an obstacle near the vehicle, which extends in x from -0.4 to 3.1 m about its position, or "".
std::string refusalWith(const std::string& more) {
  try {
    checkVehicleSurroundings(setDownScene("position = [2, 0]\n" + more, true));
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

std::string box(double x, double y, const char* more = "") {
  return fmt::format("[driver]\nsprocket_speed = 2\n[[box]]\nposition = [{}, {}, 0.3]\nsize = [0.4, 0.4, 0.6]\n"
                     "material = \"soil\"\nname = \"rock\"\n{}",
                     x, y, more);
}

const char* const kMoves = "velocity = [0, -0.1, 0]\n";

TEST(Surroundings, WhatMovesWhereTheVehicleIsSetDown_IsRefused) {
  for (const std::string& more :
       {box(3, 0.9, kMoves), box(2, 0, kMoves),
        std::string("[[cylinder]]\nposition = [3, 0, 0.5]\naxis = [0, 1, 0]\nradius = 0.3\n"
                    "length = 2\nmaterial = \"soil\"\nname = \"rock\"\nspin = [0, 1, 0]\n"),
        std::string("[[plane]]\npoint = [3, 0, 0]\nnormal = [-1, 0, 0]\nmaterial = \"soil\"\nname = \"rock\"\n"
                    "velocity = [0, 1, 0]\n")}) {
    const std::string message = refusalWith(more);
    for (const char* word : {"set_down.toml:", "\"rock\"", "moves", "at the vehicle's initial position", "pass through",
                             "remove its motion"})
      EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
  }
}

TEST(Surroundings, WhatMovesInItsWay_IsRefused) {
  const std::string message = refusalWith(box(6, -0.9, kMoves)); // it drives 1.7 m
  EXPECT_NE(message.find("in the path of the vehicle, which can travel 1.7 m"), std::string::npos) << message;
  EXPECT_NE(message.find("shorten run.duration"), std::string::npos);
}

TEST(Surroundings, WhatItCannotReach_IsNot) {
  EXPECT_EQ(refusalWith(box(9, 0, kMoves)), "") << "beyond its path";
  EXPECT_EQ(refusalWith(box(6, 2, kMoves)), "") << "beside it";
  EXPECT_EQ(refusalWith(box(0.7, 0, kMoves)), "") << "behind it";
}

TEST(Surroundings, WhatRestsIsMet) {
  EXPECT_EQ(refusalWith(box(6, -0.9)), "");
  EXPECT_EQ(refusalWith(box(3, 0.9)), "");
}

TEST(Surroundings, WhatMovesIsSaid) {
  const auto warned = [](const std::string& more) {
    return vehicleWarnings(setDownScene("position = [2, 0]\n" + more, true)).size();
  };
  EXPECT_EQ(warned(box(6, 1.9)), 0u) << "it does not move";
  EXPECT_EQ(warned(box(6, 1.9, kMoves)), 1u) << "it may enter the vehicle's path";
}

TEST(Surroundings, TheEndOfTheTerrainIsSaidAhead) {
  const auto said = [](const std::string& more) {
    const auto warnings = vehicleWarnings(setDownScene(more));
    return warnings.empty() ? "" : warnings.front();
  };
  // The terrain is 12 m long; shoes extend 3.1 m ahead of the position. At 8 rad/s it drives 1.96 m/s from 0.45 s to 4
  // s.
  EXPECT_EQ(said("position = [1.8, 0]\n[driver]\nsprocket_speed = 8\n"), "") << "7.0 m of 7.1 m";
  const std::string ahead = said("position = [2.2, 0]\n[driver]\nsprocket_speed = 8\n");
  for (const char* word : {"the terrain ends 6.", "m ahead of the vehicle", "enlarge terrain.size", "run.duration"})
    EXPECT_NE(ahead.find(word), std::string::npos) << word << " in: " << ahead;
  EXPECT_NE(said("position = [2, 0]\n[driver]\nsprocket_speed = -4\n").find("m behind the vehicle"), std::string::npos);
  EXPECT_NE(said("position = [3, -1.5]\nheading = 90\n[driver]\nsprocket_speed = 4\n"), "") << "across";
  EXPECT_EQ(said("position = [6, 0]\n[driver]\nleft = 3\nright = 8\n"), "") << "the end of a turn is not predicted";
  EXPECT_EQ(said("position = [6, 0]\n[driver.table]\ntime = [0, 1, 2, 3]\nleft = [0, 5, -5, 0]\n"
                 "right = [0, 5, -5, 0]\n"),
            "")
      << "back and forth";
}

TEST(Surroundings, ATableThatBeginsWithAJump_IsSaid) {
  const auto warnings = vehicleWarnings(setDownScene("[driver.table]\ntime = [0, 1]\nleft = [2, 2]\nright = [2, 2]\n"));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("driver.table starts at 2"), std::string::npos) << warnings[0];
  EXPECT_TRUE(vehicleWarnings(setDownScene("[driver.table]\ntime = [0, 1]\nleft = [0, 2]\nright = [0, 2]\n")).empty());
}

} // namespace
} // namespace grouser::setup
