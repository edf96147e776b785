// SPDX-License-Identifier: BSD-3-Clause
// A key in the wrong section, or without a section, is found in the right one.
#include "base/error.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/support/locations.hpp"
#include "tests/runs/folder_fixture.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace grouser::scene {
namespace {

namespace fs = std::filesystem;

const std::string kScene = "version = 1\n[run]\nduration = 1\n[material.soil]\n[vehicle]\nspec = "
                           "\"vehicles/light_tracked.toml\"\n[terrain]\nkind = \"rigid\"\nheightmap = "
                           "\"heightmaps/flat.png\"\nheight_range = [0, 0]\nsize = [4, 4]\nmaterial = \"soil\"\n";

std::string complaint(const std::string& set, const std::string& more = "") {
  try {
    readSceneText(kScene + more, "scene.toml", set.empty() ? std::vector<std::string>() : std::vector{set});
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(NearestKey, StandsInTheSectionThatHasIt) {
  ASSERT_EQ(complaint("run.duration=2"), "");
  const auto meant = [](const std::string& set, const std::string& key) {
    const std::string why = complaint(set);
    EXPECT_NE(why.find("; did you mean " + key + "?"), std::string::npos) << set << ": " << why;
  };
  meant("sprocket_speed=3", "driver.sprocket_speed");
  meant("run.sprocket_speed=3", "driver.sprocket_speed");
  meant("drive.sprocket_speed=3", "driver.sprocket_speed"); // a list of mechanisms has this key
  meant("vehicle.sprocket_speeds=3", "driver.sprocket_speed");
  meant("sproket_speed=3", "driver.sprocket_speed");
  meant("output.frame_interval=1", "run.frame_interval");
  meant("run.porosity=0.4", "terrain.porosity");
  meant("porosity=0.4", "terrain.porosity");
  meant("soil.porosity=0.4", "terrain.porosity");
  meant("vehicle.grain_radii=0.01", "material.grain_radius or terrain.grain_radius");
  meant("shoe.count=48", "spec.shoe.count");
  meant("spec.road_wheel.cuont=5", "count");
  meant("terain.depth=0.2", "terrain");              // only the section is wrong
  meant("driver.sproket_speed=2", "sprocket_speed"); // only the key is wrong
  const std::string inFile = complaint("", "[driver]\nduration = 3\n");
  EXPECT_NE(inFile.find("scene.toml:14: unknown key driver.duration; did you mean run.duration?"), std::string::npos)
      << inFile;
}

TEST(NearestKey, OfAVehicleFileStandsInTheSectionThatHasIt) {
  const fs::path spec = support::shareFolder() / "assets/vehicles/light_tracked.toml";
  std::string text = test::contents(spec);
  const std::size_t at = text.find("[idler]\n");
  ASSERT_NE(at, std::string::npos);
  const fs::path wrong = fs::path(::testing::TempDir()) / "grouser_wrong_vehicle.toml";
  test::put(wrong, text.insert(at + 8, "pin_damping = 3\n"));
  std::string why;
  try {
    vehicle::readVehicleSpec(wrong.string());
  } catch (const base::InputError& error) {
    why = error.what();
  }
  fs::remove(wrong);
  EXPECT_NE(why.find("unknown key idler.pin_damping; did you mean shoe.pin_damping?"), std::string::npos) << why;
}

TEST(NearestFile, IsFoundBesideAndAmongTheShippedScenes) {
  const fs::path scenes = support::shareFolder() / "runs/scenes";
  EXPECT_NE(support::nearestFileHint(scenes / "drawbr.toml", {}).find("drawbar.toml?"), std::string::npos);
  EXPECT_NE(support::nearestFileHint("drawbar.toml", {scenes}).find("drawbar.toml?"), std::string::npos);
  EXPECT_NE(support::nearestFileHint("drawbar", {scenes}).find("drawbar.toml?"), std::string::npos);
  EXPECT_EQ(support::nearestFileHint("nosuch.toml", {scenes}), "");
  EXPECT_EQ(support::nearestFileHint("nowhere/at/all.toml", {}), "");
}

} // namespace
} // namespace grouser::scene
