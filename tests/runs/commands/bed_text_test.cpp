// SPDX-License-Identifier: BSD-3-Clause
// What a run says of its grains, and of a bed that is too small for its vehicle.
#include "runs/commands/bed_text.hpp"

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
  const TrackOnBed good{0.28, 1.9, 0.45, 4.6, 0.014, true, true};
  EXPECT_TRUE(bedNotes(good).empty());
  const auto only = [&](auto change, const char* word) {
    TrackOnBed t = good;
    change(t);
    const std::vector<std::string> notes = bedNotes(t);
    return notes.size() == 1 && notes.front().find(word) != std::string::npos;
  };
  EXPECT_TRUE(only([](TrackOnBed& t) { t.thickness = 0.44; }, "terrain.depth = 0.45"));
  TrackOnBed coarse = good; // asked for 0.45 m
  coarse.meanDiameter = 0.08, coarse.thickness = 0.43;
  EXPECT_EQ(bedNotes(coarse).size(), 1u) << "of its grains alone";
  EXPECT_TRUE(only([](TrackOnBed& t) { t.width = 4.5; }, "terrain.size of 4.6 m"));
  EXPECT_TRUE(only([](TrackOnBed& t) { t.meanDiameter = 0.015; }, "terrain.grain_radius = 0.007"));
  EXPECT_TRUE(only([](TrackOnBed& t) { t.roughFloor = false; }, "terrain.floor_grains"));
  TrackOnBed periodic = good;
  periodic.width = 2, periodic.walls = false;
  EXPECT_TRUE(bedNotes(periodic).empty());
}

} // namespace grouser::commands
