// SPDX-License-Identifier: BSD-3-Clause
// What a run says of its grains, and of a bed that is too small for its vehicle.
#include "runs/commands/bed_text.hpp"
#include "runs/setup/load_scene.hpp"

#include <gtest/gtest.h>

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
  EXPECT_TRUE(only([](TrackOnBed& t) { t.thickness = 0.44; }, "terrain.depth = 0.45"));
  TrackOnBed coarse = good; // asked for 0.45 m
  coarse.meanDiameter = coarse.pressedDiameter = 0.08, coarse.thickness = 0.43;
  EXPECT_EQ(bedNotes(coarse).size(), 1u) << "of its grains alone";
  EXPECT_TRUE(only([](TrackOnBed& t) { t.width = 4.5; }, "terrain.size of 4.6 m"));
  EXPECT_TRUE(only([](TrackOnBed& t) { t.pressedDiameter = 0.015; }, "terrain.grain_radius = 0.007"));
  EXPECT_TRUE(only([](TrackOnBed& t) { t.roughFloor = false; }, "terrain.floor_grains"));
  TrackOnBed graded = good; // coarse below
  graded.meanDiameter = 0.08, graded.thickness = 0.43;
  EXPECT_TRUE(bedNotes(graded).empty());
  TrackOnBed periodic = good;
  periodic.width = 2, periodic.walls = false;
  EXPECT_TRUE(bedNotes(periodic).empty());
}

TEST(BedNotes, CountTheGrainsAtTheSurfaceOfABedThatIsCoarserBelow) {
  const std::string text = "version = 1\n[run]\nduration = 0.01\n[material.soil]\nstiffness = 2e5\nfriction = 0.5\n"
                           "[terrain]\nheightmap = \"heightmaps/flat.png\"\nheight_range = [0, 0]\nsize = [3.6, 2.6]\n"
                           "material = \"soil\"\ngrain_radius = 0.04\ndepth = 0.4\nfine_depth = 0.1\n"
                           "coarsening = 0.2\ncoarsest_radius = 0.07\nsettle_kinetic_energy = 0.3\n"
                           "[vehicle]\nspec = \"vehicles/light_tracked.toml\"\nsphere_radius = 0.03\n";
  const simulation::Simulation simulation(setup::simulationSetup(setup::parseScene(text, "scene.toml")),
                                          base::cpuExec(2), [](double, double) {});
  ASSERT_GT(simulation.ground().structure->meanDiameter, 0.085) << "of all";
  bool told = false;
  for (const std::string& note : bedNotes(simulation)) told |= note.find("a pad is 3.5 mean grains wide") == 0;
  EXPECT_TRUE(told) << "0.28 m over 0.08 m";
}

} // namespace grouser::commands
