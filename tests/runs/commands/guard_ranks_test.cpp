// SPDX-License-Identifier: BSD-3-Clause
// The guard's verdict is the same as on one rank: accepted runs, time of the stop, and cause.
#include "tests/runs/ranks_fixture.hpp"
#include "tests/system/guard_scenes.hpp"

#include <gtest/gtest.h>

namespace grouser::commands {

using namespace test; // fixtures and pieces of scenes

namespace {

class GuardOnRanks : public OnRanks {
protected:
  /// Message of the program when it stops, without the place of the checkpoint.
  std::string verdict(int ranks, const std::string& scene) const {
    put(folder_ / "scene.toml", scene);
    const Outcome o = OnRanks::run(ranks, "run scene.toml --out out --force --threads 1 --set output.plots=false --set "
                                          "output.picture=false --set output.frames=false");
    EXPECT_EQ(o.code, 3) << o.out << o.errors;
    const std::size_t from = o.errors.find("step ");
    if (from == std::string::npos) return o.errors;
    return o.errors.substr(from, std::min(o.errors.find(" (last checkpoint", from), o.errors.find('\n', from)) - from);
  }
};

TEST_F(GuardOnRanks, StepsThatMakeEnergyAreStoppedAtTheStepOfOneRank) {
  const std::string scene =
      test::run(0.3, "gravity = [0, 0, 0]\nimpact_speed = 1e-3\ntime_step = 6.7e-5\nmax_overlap = 0.5\n") +
      hertz(1, 0.5, "1e9") + test::floor() + walls(0.04) + plane("[0, 0, 0.08]", "[0, 0, -1]") +
      grains({60, 0.04, 0, 0.08, "0.005", "velocity = [0.8, 0.5, 0.3]\n"});
  const std::string one = verdict(1, scene);
  EXPECT_NE(one.find("time integration created"), std::string::npos) << one;
  EXPECT_EQ(verdict(2, scene), one);
}

TEST_F(GuardOnRanks, WhatPressesAGrainIsNamedAlike) {
  const std::string scene = test::run(0.3, "periodic = [true, false]\ndomain_x = [-0.03, 0.03]\n") + soil(0.5, 0.5) +
                            test::floor() + plane("[0, -0.03, 0]", "[0, 1, 0]") + plane("[0, 0.03, 0]", "[0, -1, 0]") +
                            grains({}) +
                            box("[0, 0, 0.08]", "[0.2, 0.058, 0.01]", "name = \"piston\"\nvelocity = [0, 0, -0.5]\n");
  const std::string one = verdict(1, scene);
  EXPECT_NE(one.find("it is pinched between"), std::string::npos) << one;
  EXPECT_EQ(verdict(2, scene), one);
}

TEST_F(GuardOnRanks, ASoundHeapAtItsLimitPasses) {
  put(folder_ / "scene.toml", heap(0.2, soil(0.5, 0.5), {}, "time_step = 8.43e-5\n"));
  const std::string words = "run scene.toml --force --hash --set output.plots=false --set output.picture=false --out ";
  const Outcome one = OnRanks::run(1, words + "one"), two = OnRanks::run(2, words + "two");
  EXPECT_EQ(one.code, 0) << one.errors;
  EXPECT_TRUE(one.hasHash());
  EXPECT_EQ(two.hash(), one.hash()) << two.errors;
}

} // namespace
} // namespace grouser::commands
