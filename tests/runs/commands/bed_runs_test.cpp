// SPDX-License-Identifier: BSD-3-Clause
// Lines of runs on beds: friction trials of the preparation, and bodies that leave the bed.
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <string>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

class BedRuns : public ProgramTest {
protected:
  /// A small bed; the run takes ten steps.
  void write(const std::string& terrain, const std::string& more = "") const {
    put(folder_ / "bed.toml",
        "version = 1\n[run]\nduration = 2e-3\ntime_step = 2e-4\nthreads = 1\n[material.sand]\nstiffness = 2e4\n"
        "density = 2000\nfriction = 0.5\n[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [0.4, 0.4]\n"
        "height_range = [0, 0]\nmaterial = \"sand\"\ngrain_radius = 0.02\n" +
            terrain + more + "[output]\nplots = false\npicture = false\nframes = false\n");
  }
  static std::size_t count(const std::string& text, const std::string& words) {
    std::size_t found = 0;
    for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++found;
    return found;
  }
};

TEST_F(BedRuns, FrictionTrialsOfAPreparationAreAnnouncedInOneLine) {
  write("depth = 0.16\nporosity = 0.4\nsettle_kinetic_energy = 1e-2\n");
  const Outcome prepared = call("run bed.toml --out a");
  ASSERT_EQ(prepared.code, 0) << prepared.errors;
  EXPECT_EQ(count(prepared.out, "settling  for terrain.porosity = 0.4, samples of the bed settle first"), 1u)
      << prepared.out;
  write("depth = 0.16\nsettle_kinetic_energy = 1e-2\n");
  const Outcome plain = call("run bed.toml --out b");
  ASSERT_EQ(plain.code, 0) << plain.errors;
  EXPECT_EQ(count(plain.out, "settling "), 0u) << plain.out;
}

TEST_F(BedRuns, OnlyABodyThatLeavesTheBedIsAWarning) {
  const auto ball = [](const std::string& position) {
    return "[[body]]\nname = \"ball\"\nposition = " + position +
           "\nmaterial = \"sand\"\n[[body.shape]]\nkind = \"sphere\"\nradius = 0.05\n";
  };
  const std::string lattice = "layers = 1\narrangement = \"lattice\"\nsettle_time_limit = 0\nfloor_grains = false\n";
  write(lattice, ball("[0.2, 0.2, 0.3]"));
  const Outcome inside = call("run bed.toml --out a");
  ASSERT_EQ(inside.code, 0) << inside.errors;
  EXPECT_EQ(count(inside.out + inside.errors, "WARNING"), 0u) << inside.out << inside.errors;
  EXPECT_EQ(count(inside.errors, "grouser: note: the walls and the floor of the bed have contact with grains only"), 1u)
      << inside.errors;
  write(lattice, ball("[1.2, 0.2, 0.3]"));
  const Outcome outside = call("run bed.toml --out b");
  ASSERT_EQ(outside.code, 0) << outside.errors;
  EXPECT_EQ(count(outside.out, "WARNING: ball ends outside the bed"), 1u) << outside.out << outside.errors;
}

} // namespace
} // namespace grouser::commands
