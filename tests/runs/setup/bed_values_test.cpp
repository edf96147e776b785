// SPDX-License-Identifier: BSD-3-Clause
// Boundaries and settling criteria of a scene's bed.
#include "runs/setup/bed_options.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"

#include "base/error.hpp"
#include "runs/scene/scene.hpp"

#include <gtest/gtest.h>

namespace grouser::setup {
namespace {

scene::Scene bed(const std::string& more, const char* size = "0.8, 0.8", const char* depth = "0.3") {
  return parseScene("version = 1\n[run]\nduration = 1\n[material.soil]\nstiffness = 1e5\nfriction = 0.4\n"
                    "[terrain]\nheightmap = \"heightmaps/flat.png\"\nheight_range = [0, 0]\n"
                    "material = \"soil\"\ngrain_radius = 0.025\ndepth = " +
                        std::string(depth) + "\nsize = [" + size + "]\n" + more,
                    "bed.toml");
}

TEST(BedValues, SideWallsAreSmoothUnlessTheirFrictionIsGiven) {
  for (const auto& [more, friction] : {std::pair{"", 0.0}, {"wall_friction = 0.3\n", 0.3}}) {
    const coupling::GroundSetup ground = groundSetup(bed(more), 1e-5);
    const terrain::Boundaries& around = ground.grains->boundaries;
    ASSERT_EQ(around.walls.size(), 4u);
    for (const terrain::Wall& wall : around.walls) EXPECT_EQ(wall.law.friction, friction);
    EXPECT_EQ(ground.grains->model.law.friction, 0.4);
  }
}

TEST(BedValues, TheFloorOfAGradedBedIsOfItsCoarsestGrains) {
  EXPECT_EQ(bedOptions(bed("")).floorGrains->scale, 1);
  // 0.2 m below the fine grains the radius is larger by 0.02 of that depth.
  const terrain::BedOptions graded = bedOptions(bed("fine_depth = 0.1\ncoarsening = 0.02\ncoarsest_radius = 0.05\n"));
  EXPECT_NEAR(graded.floorGrains->scale, 1 + 0.02 * 0.2 / 0.025, 1e-12);
}

/// With almost no friction, one end of the porosity bisection, random spins of grains never decay.
TEST(BedValues, GrainsAtRandomRestThoughTheySpin) {
  const auto restsBySpins = [](const std::string& more) {
    return groundSetup(bed(more), 1e-5).grains->bed->settle.spins;
  };
  EXPECT_FALSE(restsBySpins(""));
  EXPECT_FALSE(restsBySpins("porosity = 0.4\n"));
  EXPECT_FALSE(groundSetup(bed("porosity = 0.4\n"), 1e-5).grains->bed->preparation->sample->grains->bed->settle.spins);
}

TEST(BedValues, HoldTheLargestGrainAndWhereAPorosityIsAskedForAnInterior) {
  const auto refused = [](const std::string& more, const char* depth, const std::string& why) {
    try {
      bed(more, "0.8, 0.8", depth);
    } catch (const base::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
      return true;
    }
    return false;
  };
  const std::string wide = "radius_distribution = \"lognormal\"\nradius_spread = 0.9\n"; // up to 25 mm e^1.8
  EXPECT_TRUE(refused(wide, "0.15", "the largest grain radius; set at least 0.1512"));
  EXPECT_FALSE(refused(wide, "0.152", ""));
  EXPECT_TRUE(refused("porosity = 0.4\n", "0.149", "terrain.porosity"));
  EXPECT_FALSE(refused("porosity = 0.4\n", "0.15", ""));
}

/// Energy unit m g radius of the bed's own mean grain: a rolling coarse grain weighs as much as hundreds of fine ones.
TEST(BedValues, AGradedBedRestsByItsOwnGrains) {
  const auto unit = [](const std::string& more) { return groundSetup(bed(more), 1e-5).grains->bed->restEnergy; };
  const terrain::DepthGrading grading{0.1, 0.2, 0.05};
  const std::string graded = "fine_depth = 0.1\ncoarsening = 0.2\ncoarsest_radius = 0.05\n";
  EXPECT_NEAR(unit(graded) / unit(""), grading.meanFourthPower(0.3, 0.025), 1e-9);
  EXPECT_GT(unit(graded), 2 * unit(""));
}

/// Grains of 50 mm +- 25 %, which a road wheel may roll over.
TEST(BedValues, StonesGetBetweenWheelsAndPlatesWhereSoilContactThem) {
  const std::string vehicle = "[vehicle]\nspec = \"vehicles/light_tracked.toml\"\nsphere_radius = 0.03\n";
  const auto stone = [&](const std::string& more) {
    const scene::Scene scene = bed(vehicle + more, "4.9, 2.5");
    return simulationSetup(scene).vehicle->thickestStone;
  };
  EXPECT_NEAR(stone(""), 0.0625, 1e-6);
  EXPECT_EQ(stone("soil_contact = \"shoes\"\n"), 0);
}

} // namespace
} // namespace grouser::setup
