// SPDX-License-Identifier: BSD-3-Clause
// Messages of a run on its grains, and on a bed that is too small for its vehicle.
#include "runs/commands/bed_text.hpp"
#include "runs/commands/bed_warnings.hpp"
#include "runs/commands/plan.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/support/locations.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include <filesystem>

namespace grouser::commands {

TEST(GrainsText, NamesAllRadiiAndTheGrainsThatNeverMove) {
  terrain::GrainModel model;
  model.radius = 0.03, model.mass = 0.2, model.timeStep = 1e-4;
  model.gravity = {0, 0, -9.81}, model.law.stiffness = 1e5;
  const std::vector<terrain::GrainSpec> alike{{{0, 0, 0}, {}, {}}, {{1, 0, 0}, {}, {}}};
  EXPECT_EQ(grainsText(terrain::Grains(base::cpuExec(1), model, {}, alike)), "2 of radius 0.03 m");
  std::vector<terrain::GrainSpec> mixed = alike;
  mixed[0].radius = 0.02, mixed[1].fixed = true;
  EXPECT_EQ(grainsText(terrain::Grains(base::cpuExec(1), model, {}, mixed)), "2 of radius 0.02 to 0.03 m, 1 fixed");
}

TEST(BedNotes, NameEachRuleThatABedBreaksWithItsRemedy) {
  const TrackOnBed good{0.28, 1.9, 0.45, 4.6, 0.014, true, true, 0.014};
  EXPECT_TRUE(bedNotes(good).empty());
  const auto only = [&](auto change, const char* word) {
    TrackOnBed t = good;
    change(t);
    const std::vector<std::string> notes = bedNotes(t);
    return notes.size() == 1 && notes.front().find(word) != std::string::npos;
  };
  EXPECT_TRUE(only([](TrackOnBed& t) { t.thickness = 0.44; }, "terrain.depth >= 0.45 m"));
  TrackOnBed coarse = good; // 0.45 m requested
  coarse.meanDiameter = coarse.pressedDiameter = 0.08, coarse.thickness = 0.43;
  EXPECT_EQ(bedNotes(coarse).size(), 1u) << "only on its grains";
  EXPECT_TRUE(only([](TrackOnBed& t) { t.width = 4.5; }, "the width in terrain.size to 4.6 m or more"));
  EXPECT_TRUE(only([](TrackOnBed& t) { t.pressedDiameter = 0.015; }, "terrain.grain_radius <= 0.007 m"));
  EXPECT_TRUE(only([](TrackOnBed& t) { t.roughFloor = false; }, "terrain.floor_grains"));
  TrackOnBed graded = good; // coarse below
  graded.meanDiameter = 0.08, graded.thickness = 0.43;
  EXPECT_TRUE(bedNotes(graded).empty());
  TrackOnBed periodic = good;
  periodic.width = 2, periodic.walls = false;
  EXPECT_TRUE(bedNotes(periodic).empty());
}

TEST(BedNotes, ArePlannedBeforeTheBedIsLaid) {
  const auto sceneOf = [](const std::string& keys) {
    return setup::parseScene("version = 1\n[run]\nduration = 0.01\n[material.soil]\nstiffness = 2e5\n"
                             "[terrain]\nheightmap = \"heightmaps/flat.png\"\nheight_range = [0, 0]\n"
                             "size = [6, 4.6]\nmaterial = \"soil\"\n" +
                                 keys,
                             "scene.toml");
  };
  const auto notes = [&](const std::string& keys) { return bedNotes(sceneOf(keys)); };
  const std::string vehicle = "[vehicle]\nspec = \"vehicles/light_tracked.toml\"\n";
  const std::vector<std::string> coarse = notes("grain_radius = 0.027\ndepth = 0.46\n" + vehicle);
  ASSERT_EQ(coarse.size(), 1u);
  EXPECT_EQ(coarse.front().find("track pads are only 5.2 mean grain diameters wide"), 0u) << coarse.front();
  EXPECT_NE(planText(sceneOf("grain_radius = 0.027\ndepth = 0.46\n" + vehicle)).find("note: " + coarse.front()),
            std::string::npos);
  EXPECT_TRUE(notes("grain_radius = 0.007\ndepth = 0.46\n" + vehicle).empty());
  EXPECT_TRUE(notes("grain_radius = 0.027\ndepth = 0.46\n").empty()) << "no vehicle";
}

TEST(BedNotes, CountTheGrainsAtTheSurfaceOfABedThatIsCoarserBelow) {
  const std::string text = "version = 1\n[run]\nduration = 0.01\n[material.soil]\nstiffness = 2e5\nfriction = 0.5\n"
                           "[terrain]\nheightmap = \"heightmaps/flat.png\"\nheight_range = [0, 0]\nsize = [3.6, 2.6]\n"
                           "material = \"soil\"\ngrain_radius = 0.04\ndepth = 0.4\nfine_depth = 0.1\n"
                           "coarsening = 0.2\ncoarsest_radius = 0.07\nsettle_kinetic_energy = 0.3\n"
                           "[vehicle]\nspec = \"vehicles/light_tracked.toml\"\nsphere_radius = 0.03\n";
  const coupling::Simulation simulation(setup::simulationSetup(setup::parseScene(text, "scene.toml")), base::cpuExec(2),
                                        [](double, double) {});
  ASSERT_GT(simulation.ground().structure->meanDiameter, 0.085) << "mean over all grains";
  bool printed = false;
  for (const std::string& note : bedNotes(simulation))
    printed |= note.find("track pads are only 3.5 mean grain diameters wide") == 0;
  EXPECT_TRUE(printed) << "0.28 m over 0.08 m";
}

TEST(PorosityWarning, NamesLeaningGravityWhereTheBedHasMovedAfterItsPreparation) {
  terrain::BedStructure bed;
  bed.porosity = 0.427, bed.porosityError = 0.001, bed.grains = 500;
  const std::string leaning = porosityWarning(0.40, bed, {5.627, 0, -8.036}),
                    level = porosityWarning(0.40, bed, {0, 0, -9.81});
  for (const char* part :
       {"porosity of 0.427", "terrain.porosity = 0.4:", "vertical gravity", "tilted run.gravity (35.0 degrees)"})
    EXPECT_NE(leaning.find(part), std::string::npos) << leaning;
  EXPECT_NE(level.find("enlarge terrain.size or depth"), std::string::npos) << level;
  EXPECT_EQ(leanOf({0, 0, -9.81}), 0);
  EXPECT_EQ(leanOf({}), 0);
  bed.porosity = 0.409;
  EXPECT_EQ(porosityWarning(0.40, bed, {5.627, 0, -8.036}), "") << "as close as beds get";
  bed.porosity = 0.427, bed.porosityError = 0.01;
  EXPECT_EQ(porosityWarning(0.40, bed, {0, 0, -9.81}), "") << "too few grains for a reliable measurement";
}

/// Stored with the other warnings of a bed, for the manifest and the report.
TEST(PorosityWarning, IsOneOfTheWarningsOfARunsBed) {
  const scene::Scene scene = setup::parseScene(
      "version = 1\n[run]\nduration = 0.01\ngravity = [5.627, 0, -8.036]\n[material.m]\nstiffness = 2e3\n"
      "restitution = 0.3\nfriction = 0.5\n[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [0.4, 0.24]\n"
      "height_range = [0, 0]\nmaterial = \"m\"\ngrain_radius = 0.02\ndepth = 0.12\nporosity = 0.40\n",
      "scene.toml");
  const coupling::Simulation simulation(setup::simulationSetup(scene), base::cpuExec(2), [](double, double) {});
  const std::string porosity = porosityWarning(simulation);
  ASSERT_NE(porosity, "");
  const std::vector<std::string> warnings = bedWarnings(scene, simulation);
  EXPECT_NE(std::find(warnings.begin(), warnings.end(), porosity), warnings.end());
}

TEST(Plan, SaysThatAPorosityIsPreparedStraightDown) {
  const auto plan = [](const std::string& gravity) {
    return planText(setup::parseScene("version = 1\n[run]\nduration = 0.01\ngravity = " + gravity +
                                          "\n[material.soil]\nstiffness = 2e5\n[terrain]\nheightmap = "
                                          "\"heightmaps/flat.png\"\nheight_range = [0, 0]\nsize = [0.6, 0.6]\n"
                                          "material = \"soil\"\ngrain_radius = 0.03\ndepth = 0.25\nporosity = 0.4\n",
                                      "scene.toml"));
  };
  const std::string note = "under vertical gravity; the tilted run.gravity (35.0 degrees)";
  EXPECT_NE(plan("[5.627, 0, -8.036]").find(note), std::string::npos);
  EXPECT_EQ(plan("[0, 0, -9.81]").find("gravity; the tilted"), std::string::npos);
}

TEST(BedWarnings, NameBedsThatAreNone) {
  const BedQuality good{10000, 800, 9000, 0.42, 0.005};
  EXPECT_TRUE(bedWarnings(good).empty());
  BedQuality bad = good; // a run without a warning
  bad.grains = 400, bad.fixed = 300, bad.porosity = 0.68, bad.measured = 40;
  const std::vector<std::string> both = bedWarnings(bad);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_NE(both[0].find("75 % of the bed's grains are fixed on its floor (300 of 400)"), std::string::npos) << both[0];
  EXPECT_NE(both[1].find("porosity of 0.68"), std::string::npos) << both[1];
  BedQuality loose = good; // the limit depends on friction and cohesion
  loose.porosity = 0.51;
  EXPECT_EQ(bedWarnings(loose).size(), 1u);
  loose.rollingFriction = true;
  EXPECT_TRUE(bedWarnings(loose).empty());
  loose.porosity = 0.58;
  EXPECT_EQ(bedWarnings(loose).size(), 1u);
  loose.cohesion = true;
  EXPECT_TRUE(bedWarnings(loose).empty());
  loose.porosity = 0.68;
  EXPECT_EQ(bedWarnings(loose).size(), 1u);
  BedQuality unsure = good;
  unsure.porosity = 0.6, unsure.porosityError = 0.05;
  EXPECT_TRUE(bedWarnings(unsure).empty()) << "within three standard errors";
  BedQuality unknown = good;
  unknown.measured = 0, unknown.porosity = 0;
  EXPECT_TRUE(bedWarnings(unknown).empty());
}

TEST(BedWarnings, ShippedScenesHaveNone) {
  for (const auto& entry : std::filesystem::directory_iterator(support::shareFolder() / "runs/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    const scene::Scene scene = setup::loadScene(entry.path());
    const std::vector<std::string> warnings = plannedBedWarnings(scene);
    EXPECT_TRUE(warnings.empty()) << entry.path() << ": " << warnings.front();
  }
}

TEST(BedWarnings, TellOfAThinBedBeforeItIsLaid) {
  const std::string text = "version = 1\n[run]\nduration = 0.01\n[material.soil]\nstiffness = 2e5\n[terrain]\n"
                           "heightmap = \"heightmaps/flat.png\"\nheight_range = [0, 0]\nsize = [1, 1]\n"
                           "material = \"soil\"\ngrain_radius = 0.02\ndepth = ";
  const auto warnings = [&](const std::string& depth) {
    return plannedBedWarnings(setup::parseScene(text + depth + "\n", "scene.toml"));
  };
  EXPECT_TRUE(warnings("0.2").empty());
  ASSERT_EQ(warnings("0.04").size(), 1u);
  EXPECT_NE(warnings("0.04").front().find("are fixed on its floor"), std::string::npos);
  // On a smooth floor: at 2.5 diameters apart, one layer covers an eighth of it.
  const auto sparse = [&](const std::string& layers) {
    return plannedBedWarnings(setup::parseScene(text.substr(0, text.find("depth")) + "layers = " + layers +
                                                    "\narrangement = \"lattice\"\nspacing = 5\nfloor_grains = false\n",
                                                "scene.toml"));
  };
  ASSERT_EQ(sparse("1").size(), 1u);
  EXPECT_NE(sparse("1").front().find("% of its floor (less than one layer)"), std::string::npos);
  EXPECT_TRUE(sparse("5").empty());
}

} // namespace grouser::commands
